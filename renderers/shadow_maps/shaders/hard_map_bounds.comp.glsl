// Pass: tight bounds of the queued pairs' images. In, out: queue.

#include "renderers/shadow_maps/shaders/map_bounds.glsl"
#include "renderers/shadow_maps/shaders/map_queue.glsl"
#include "renderers/shadow_maps/shaders/map_triangle.glsl"

layout(local_size_x = 64) in;

void main() {
  int stride = int(gl_NumWorkGroups.x * gl_WorkGroupSize.x);
  int count = queued_pairs();
  for (int i = int(gl_GlobalInvocationID.x); i < count; i += stride) {
    LargePair pair = large_pairs[i];
    MapTriangle t = map_triangle(pair.triangle, map_center(pair.layer));
    vec4 bounds = triangle_bounds(t.vertex);
    ivec4 covered = texels_of(bounds.xy, bounds.zw);
    bool is_empty = bounds.x > bounds.z || any(greaterThan(covered.xy, covered.zw));
    large_pairs[i].least = is_empty ? 1u : pack_texel(covered.xy);
    large_pairs[i].greatest = is_empty ? 0u : pack_texel(covered.zw);
  }
}
