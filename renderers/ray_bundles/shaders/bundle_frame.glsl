// The frame of the bundle (`BundleFrame`).
uniform vec3 axis_x;
uniform vec3 axis_y;
uniform vec3 direction;
uniform vec3 corner;  // of pixel (0, 0), world space, m
uniform float pixel_m;
