// Pass: every crossing into its texel's list, in any order; a thread per line.
// In: nodes, counts per line; starts of the texels' lists; nodes per texel, which end as 0.
// Out: per place in a list twice the node's index, + 1 if the texel's back looks back on the line.

#include "renderers/ray_bundles/shaders/list_node.glsl"
#include "renderers/ray_bundles/shaders/thread_index.glsl"

layout(std430, binding = 0) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 1) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 2) readonly buffer Nodes { ListNode nodes[]; };
layout(std430, binding = 4) buffer TexelCounts { uint texel_counts[]; };
layout(std430, binding = 5) readonly buffer TexelStarts { uint texel_starts[]; };
layout(std430, binding = 6) writeonly buffer TexelNodes { uint texel_nodes[]; };

uniform uint line_count;

void main() {
  uint line = thread_index();
  if (line >= line_count) return;
  uint end = starts[line] + counts[line];
  for (uint i = starts[line]; i < end; ++i) {
    uint near_side = nodes[i].near_side;
    uint texel = near_side >> 1;
    uint left = atomicAdd(texel_counts[texel], 0xffffffffu);
    texel_nodes[texel_starts[texel] + left - 1u] = 2u * i + (near_side & 1u);
  }
}
