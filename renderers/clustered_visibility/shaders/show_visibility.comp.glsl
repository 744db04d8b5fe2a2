// Pass: the share of one area light that every pixel sees, for the eye.
// In: geometry buffer, area lights and their maps. Out: rgba32f, the share in rgb; 0 off surfaces.

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;  // geometric
layout(rgba32f, binding = 0) writeonly uniform image2D shown;

#include "renderers/clustered_visibility/shaders/area_visibility.glsl"

uniform int cluster;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(shown)))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  float share = 0.0;
  if (position.w > 0.0 && area_lights[cluster].position.w > 0.0) {
    look_at_area(cluster);
    share = area_visibility(position.xyz, texelFetch(normal_map, pixel, 0).xyz);
  }
  imageStore(shown, pixel, vec4(vec3(share), 1.0));
}
