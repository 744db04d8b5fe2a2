// Pass: levels 0, 1 and 2 of one quantity of convolution shadow maps; a thread per 4 x 4 texels.
// In: distances and area lights. Out: textures of the quantity, and level 2 before it is rounded,
// from which mip_level.comp.glsl makes the rest: every level is rounded once.

#include "renderers/clustered_visibility/shaders/depth_series.glsl"
#include "renderers/clustered_visibility/shaders/level_sums.glsl"
#include "renderers/clustered_visibility/shaders/stored_value.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(FORMAT, binding = 0) writeonly uniform image2DArray first_level_0;
layout(FORMAT, binding = 1) writeonly uniform image2DArray first_level_1;
layout(FORMAT, binding = 2) writeonly uniform image2DArray first_level_2;
#ifndef ONE_TEXTURE
layout(FORMAT, binding = 3) writeonly uniform image2DArray second_level_0;
layout(FORMAT, binding = 4) writeonly uniform image2DArray second_level_1;
layout(FORMAT, binding = 5) writeonly uniform image2DArray second_level_2;
#endif

// Mean over 2 x 2 texels of level 0.
void make_square(ivec2 corner, int layer, int group, out vec4 first_mean, out vec4 second_mean) {
  int target = layer * GROUPS + group;
  first_mean = vec4(0.0);
  second_mean = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = corner + ivec2(i & 1, i >> 1);
    vec4 first;
    vec4 second;
    basis_at(depth_at(texel, layer), group, first, second);
    imageStore(first_level_0, ivec3(texel, target), stored_value(first));
    first_mean += 0.25 * first;
#ifndef ONE_TEXTURE
    imageStore(second_level_0, ivec3(texel, target), stored_value(second));
    second_mean += 0.25 * second;
#endif
  }
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  int layer = int(gl_GlobalInvocationID.z);
  if (any(greaterThanEqual(block, ivec2(level_side(2)))) || is_empty_layer(layer)) return;
  for (int group = 0; group < GROUPS; ++group) {
    int target = layer * GROUPS + group;
    LevelSum sum = LevelSum(vec4(0.0), vec4(0.0));
    for (int i = 0; i < 4; ++i) {
      ivec2 texel = 2 * block + ivec2(i & 1, i >> 1);
      vec4 first;
      vec4 second;
      make_square(2 * texel, layer, group, first, second);
      imageStore(first_level_1, ivec3(texel, target), stored_value(first));
      sum.first += 0.25 * first;
#ifndef ONE_TEXTURE
      imageStore(second_level_1, ivec3(texel, target), stored_value(second));
      sum.second += 0.25 * second;
#endif
    }
    imageStore(first_level_2, ivec3(block, target), stored_value(sum.first));
#ifndef ONE_TEXTURE
    imageStore(second_level_2, ivec3(block, target), stored_value(sum.second));
#endif
    level_sums[level_index(2, block, target)] = sum;
  }
}
