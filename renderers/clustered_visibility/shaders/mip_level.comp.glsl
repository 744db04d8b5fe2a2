// Pass: one level of one quantity of convolution shadow maps, from the unrounded level below.
// In, out: sums of levels. Out: textures of the quantity.

#include "renderers/clustered_visibility/shaders/area_light.glsl"
#include "renderers/clustered_visibility/shaders/level_sums.glsl"
#include "renderers/clustered_visibility/shaders/stored_value.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 7) readonly buffer AreaLights { AreaLight area_lights[]; };
layout(FORMAT, binding = 0) writeonly uniform image2DArray first_image;
#ifndef ONE_TEXTURE
layout(FORMAT, binding = 1) writeonly uniform image2DArray second_image;
#endif

uniform int level;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  int target = int(gl_GlobalInvocationID.z);
  if (any(greaterThanEqual(texel, ivec2(level_side(level))))) return;
  if (area_lights[target / GROUPS].position.w == 0.0) return;
  LevelSum sum = LevelSum(vec4(0.0), vec4(0.0));
  for (int i = 0; i < 4; ++i) {
    LevelSum below = level_sums[level_index(level - 1, 2 * texel + ivec2(i & 1, i >> 1), target)];
    sum.first += 0.25 * below.first;
    sum.second += 0.25 * below.second;
  }
  level_sums[level_index(level, texel, target)] = sum;
  imageStore(first_image, ivec3(texel, target), stored_value(sum.first));
#ifndef ONE_TEXTURE
  imageStore(second_image, ivec3(texel, target), stored_value(sum.second));
#endif
}
