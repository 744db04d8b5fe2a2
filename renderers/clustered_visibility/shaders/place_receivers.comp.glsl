// Pass: surface points as the receivers of a gather, both sides of each; a thread per texel.
// In: the scene, points. Out: the textures of a GeometryBuffer (geometry_buffer.h).

#include "renderers/opengl/shaders/scene.glsl"
#include "renderers/clustered_visibility/shaders/placed_point.glsl"

layout(local_size_x = 64) in;

layout(rgba32f, binding = 0) uniform writeonly image2D position_map;
layout(rgba32f, binding = 1) uniform writeonly image2D geometric_normal_map;
layout(rgba32f, binding = 2) uniform writeonly image2D shading_normal_map;
layout(rgba32f, binding = 3) uniform writeonly image2D albedo_map;

void main() {
  int own = int(gl_GlobalInvocationID.x);
  ivec2 texel = texel_of(own);
  if (own >= 2 * point_count) {
    // Beyond the textures nothing is stored.
    imageStore(position_map, texel, vec4(0.0));
    imageStore(geometric_normal_map, texel, vec4(0.0));
    imageStore(shading_normal_map, texel, vec4(0.0));
    imageStore(albedo_map, texel, vec4(0.0));
    return;
  }
  bool is_back = own >= point_count;
  PlacedPoint point = points[is_back ? own - point_count : own];
  Triangle triangle = triangles[point.where.x];
  vec3 weights = corner_weights(triangle, point.position.xyz);
  int index = material_of(triangle);
  Material material = materials[index];
  float side = is_back ? -1.0 : 1.0;
  imageStore(position_map, texel, vec4(point.position.xyz, 1.0));
  imageStore(geometric_normal_map, texel, vec4(side * triangle.geometric_normal.xyz, float(index)));
  imageStore(shading_normal_map, texel, vec4(side * shading_normal_at(triangle, weights), 0.0));
  imageStore(albedo_map, texel,
             vec4(albedo_at(material, uv_at(triangle, weights)),
                  any(greaterThan(material.lobe.rgb, vec3(0.0))) ? 1.0 : 0.0));
}
