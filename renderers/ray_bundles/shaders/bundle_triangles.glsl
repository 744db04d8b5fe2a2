// Triangles of the scene as a bundle draws them; std430 mirrors of `SourceTriangle` and
// `TrianglePlane` in gpu_bundle_lists.cpp.

#include "renderers/ray_bundles/shaders/bundle_frame.glsl"

struct SourceTriangle {
  // xyz: world space, m; w of the first two: where the first corner lies in the atlas, texels.
  vec4 corners[3];
  vec4 along;       // in the atlas, texels: xy to the second corner, zw to the third
  ivec4 rectangle;  // of its chart, texels: xy lowest, zw size
};

// What the fragments of a triangle are, linear over the raster.
struct TrianglePlane {
  vec4 origin;        // of the first corner: xy raster, pixels; zw atlas, texels
  vec4 depth_m;       // x: of the first corner; yz: per pixel; w: least
  vec4 place_slopes;  // texels per pixel: xy to the right, zw up
  vec4 bounds;        // x: greatest depth, m
  vec4 weights;       // per pixel: xy of the second corner's weight, zw of the third's
};
