// Pass: what every crossing sees along its line, a thread per line.
// In: nodes, from each line's start on; counts per line. Out: per node the side before it and the
// side behind it, or the line's end; nodes per texel.

#include "renderers/ray_bundles/shaders/list_node.glsl"
#include "renderers/ray_bundles/shaders/thread_index.glsl"

layout(std430, binding = 0) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 1) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 2) readonly buffer Nodes { ListNode nodes[]; };
layout(std430, binding = 3) writeonly buffer Links { uvec2 links[]; };
layout(std430, binding = 4) buffer TexelCounts { uint texel_counts[]; };

uniform uint line_count;

void main() {
  uint line = thread_index();
  if (line >= line_count) return;
  uint begin = starts[line];
  uint end = begin + counts[line];
  uint before = kBehind;
  for (uint i = begin; i < end; ++i) {
    uint near_side = nodes[i].near_side;
    links[i] = uvec2(before, i + 1u < end ? nodes[i + 1u].near_side : kAhead);
    atomicAdd(texel_counts[near_side >> 1], 1u);
    before = near_side ^ 1u;
  }
}
