// The scene's triangles, materials and textures in storage buffers; GpuTriangle and GpuMaterial of
// gpu_scene.h. World space, metres.

struct Triangle {
  vec4 position[3];       // xyz: m; w: u of the vertex
  vec4 normal[3];         // xyz: shading normal, unit length; w: v of the vertex
  vec4 geometric_normal;  // xyz: unit length, front side; w: bits of the material's index
};

struct Material {
  vec4 albedo;         // rgb; w: bits of the texture's first texel, -1 without a texture
  vec4 lobe;           // rgb: its albedo; w: exponent of Phong, or -alpha of GGX
  vec4 emission;       // rgb: radiance
  ivec4 texture_size;  // width, height of the albedo texture, 0, 0
};

layout(std430, binding = 0) readonly buffer Triangles { Triangle triangles[]; };
layout(std430, binding = 1) readonly buffer Materials { Material materials[]; };
layout(std430, binding = 2) readonly buffer Texels { vec4 texels[]; };

int material_of(Triangle triangle) { return floatBitsToInt(triangle.geometric_normal.w); }

// Weights of the triangle's corners at a point of its plane; their sum is 1. The triangle's area
// must not be zero.
vec3 corner_weights(Triangle triangle, vec3 position) {
  vec3 a = triangle.position[0].xyz;
  vec3 ab = triangle.position[1].xyz - a;
  vec3 ac = triangle.position[2].xyz - a;
  vec3 ap = position - a;
  vec3 normal = cross(ab, ac);
  float area_squared = dot(normal, normal);
  float weight_b = dot(cross(ap, ac), normal) / area_squared;
  float weight_c = dot(cross(ab, ap), normal) / area_squared;
  return vec3(1.0 - weight_b - weight_c, weight_b, weight_c);
}

vec2 uv_at(Triangle triangle, vec3 weights) {
  return weights.x * vec2(triangle.position[0].w, triangle.normal[0].w) +
         weights.y * vec2(triangle.position[1].w, triangle.normal[1].w) +
         weights.z * vec2(triangle.position[2].w, triangle.normal[2].w);
}

// Interpolated, unit length, on the side of the geometric normal.
vec3 shading_normal_at(Triangle triangle, vec3 weights) {
  vec3 normal = weights.x * triangle.normal[0].xyz + weights.y * triangle.normal[1].xyz +
                weights.z * triangle.normal[2].xyz;
  float normal_length = length(normal);
  // Opposite vertex normals may cancel out; the flat normal is the only one left then.
  if (!(normal_length > 0.0)) return triangle.geometric_normal.xyz;
  return dot(normal, triangle.geometric_normal.xyz) < 0.0 ? normal / -normal_length
                                                          : normal / normal_length;
}

// Bilinear, rows and columns repeat, row 0 is v = 1. In 32-bit arithmetic, unlike the filters of
// some drivers.
vec3 texture_color(int first_texel, ivec2 size, vec2 uv) {
  vec2 fraction = uv - floor(uv);
  vec2 place = vec2(fraction.x, 1.0 - fraction.y) * vec2(size) - 0.5;
  vec2 low = floor(place);
  vec2 weight = place - low;
  ivec2 first = (ivec2(low) + size) % size;
  ivec2 second = (ivec2(low) + 1) % size;
  int top = first_texel + first.y * size.x;
  int bottom = first_texel + second.y * size.x;
  vec3 above = mix(texels[top + first.x].rgb, texels[top + second.x].rgb, weight.x);
  vec3 below = mix(texels[bottom + first.x].rgb, texels[bottom + second.x].rgb, weight.x);
  return mix(above, below, weight.y);
}

// Diffuse reflectance of a material, texture included.
vec3 albedo_at(Material material, vec2 uv) {
  int first_texel = floatBitsToInt(material.albedo.w);
  if (first_texel < 0) return material.albedo.rgb;
  return material.albedo.rgb * texture_color(first_texel, material.texture_size.xy, uv);
}
