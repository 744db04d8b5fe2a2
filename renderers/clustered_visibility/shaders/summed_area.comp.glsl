// Pass: summed-area tables of one quantity, in fixed point, whose differences are exact. ALONG_ROWS:
// a thread per row makes the row's running sums; else a thread per column adds up its rows.
// In: distances and area lights (ALONG_ROWS). In, out: tables.
// TABLE_SCALE: fixed-point steps per unit.
// Source: Crow 1984, "Summed-area Tables for Texture Mapping", doi:10.1145/800031.808600.

#include "renderers/clustered_visibility/shaders/depth_series.glsl"

layout(local_size_x = 32) in;

layout(rgba32i, binding = 0) uniform iimage2DArray first_table;
layout(rgba32i, binding = 1) uniform iimage2DArray second_table;

void main() {
  int line = int(gl_GlobalInvocationID.x);
  int target = int(gl_GlobalInvocationID.y);
  int side = imageSize(first_table).x;
  if (line >= side || is_empty_layer(target / GROUPS)) return;
  ivec4 first_sum = ivec4(0);
  ivec4 second_sum = ivec4(0);
  for (int i = 0; i < side; ++i) {
#ifdef ALONG_ROWS
    ivec3 texel = ivec3(i, line, target);
    vec4 first;
    vec4 second;
    basis_at(depth_at(texel.xy, target / GROUPS), target % GROUPS, first, second);
    first_sum += ivec4(round(first * float(TABLE_SCALE)));
    second_sum += ivec4(round(second * float(TABLE_SCALE)));
#else
    ivec3 texel = ivec3(line, i, target);
    first_sum += imageLoad(first_table, texel);
#ifndef DEPTH
    second_sum += imageLoad(second_table, texel);
#endif
#endif
    imageStore(first_table, texel, first_sum);
#ifndef DEPTH
    imageStore(second_table, texel, second_sum);
#endif
  }
}
