// Pass: the queued pairs, one work group each, in blocks of 8 x 8 texels.
// In: queue with bounds, triangles, origins. Out: distances (r32ui).

#include "renderers/shadow_maps/shaders/map_queue.glsl"
#include "renderers/shadow_maps/shaders/map_triangle.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  int count = queued_pairs();
  ivec2 offset = ivec2(gl_LocalInvocationID.xy);
  for (int i = int(gl_WorkGroupID.x); i < count; i += int(gl_NumWorkGroups.x)) {
    LargePair pair = large_pairs[i];
    ivec2 least = unpack_texel(pair.least);
    ivec2 greatest = unpack_texel(pair.greatest);
    if (least.x > greatest.x) continue;
    MapTriangle t = map_triangle(pair.triangle, map_center(pair.layer));
    for (int y = least.y + offset.y; y <= greatest.y; y += 8) {
      for (int x = least.x + offset.x; x <= greatest.x; x += 8) {
        draw_texel(t, ivec2(x, y), pair.layer);
#ifdef COUNT_WORK
        atomicAdd(texels_large, 1u);
#endif
      }
    }
  }
}
