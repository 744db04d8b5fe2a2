// Pass: the crossings of every line in order of their depth, ties and duplicates as in
// `order_nodes`; a thread per line. In: words (see bundle_fill.frag.glsl), triangles, planes, cells
// of the atlas, texels; with is_counted, counts that filling has brought to 0. Out: nodes, from
// each list's start on; counts of what is left in each; number of lines that were counted and
// filled differently, and of those not brought to an end (loop_probe.glsl).

#include "renderers/ray_bundles/shaders/bundle_triangles.glsl"
#include "renderers/ray_bundles/shaders/list_node.glsl"
#include "renderers/ray_bundles/shaders/loop_probe.glsl"
#include "renderers/ray_bundles/shaders/thread_index.glsl"

layout(std430, binding = 0) readonly buffer Triangles { SourceTriangle triangles[]; };
layout(std430, binding = 1) readonly buffer Planes { TrianglePlane planes[]; };
layout(std430, binding = 2) buffer Counts { uint counts[]; };
layout(std430, binding = 3) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 4) readonly buffer Words { uint words[]; };
layout(std430, binding = 5) buffer Nodes { ListNode nodes[]; };
layout(std430, binding = 6) readonly buffer Cells { uint cells[]; };  // their texels
// xyz: geometric normal; w: bits of the object's index.
layout(std430, binding = 7) readonly buffer Texels { vec4 texels[]; };

layout(std430, binding = 8) buffer Faults {
  uint faults;
  uint unordered;
};

uniform uint line_count;
uniform int is_counted;
uniform int width_px;
uniform int first_row;
uniform int atlas_side_px;
uniform float tie_m;
// How far inside: beyond the rasteriser's rounding; 0 for rays, which share edges to the bit.
uniform float edge_margin_px;

// Moves a place inside that lies beyond an edge, as the rasteriser has rounded the corners: there
// the planes of two faces that meet at the edge would have changed their order.
// @param per_px  gradient of a corner's weight  @param weight  at the first corner
vec2 off_edge(vec2 at, vec2 per_px, float weight) {
  float here = weight + dot(per_px, at);
  if (here >= 0.0) return at;
  float gradient = length(per_px);
  return at + per_px * ((edge_margin_px * gradient - here) / (gradient * gradient));
}

ListNode node_of(uint word, vec2 center_px) {
  uint index = word >> 1;
  TrianglePlane plane = planes[index];
  precise vec2 at = center_px - plane.origin.xy;
  vec2 second = plane.weights.xy;
  vec2 third = plane.weights.zw;
  at = off_edge(off_edge(off_edge(at, second, 0.0), third, 0.0), -(second + third), 1.0);
  precise vec2 place =
      plane.origin.zw + at.y * plane.place_slopes.zw + at.x * plane.place_slopes.xy;
  precise float depth_m = plane.depth_m.x + at.y * plane.depth_m.z + at.x * plane.depth_m.y;
  ivec4 rectangle = triangles[index].rectangle;
  ivec2 cell =
      ivec2(clamp(place, vec2(rectangle.xy), vec2(rectangle.xy + rectangle.zw - 1)));
  return ListNode(clamp(depth_m, plane.depth_m.w, plane.bounds.x),
              2u * cells[cell.y * atlas_side_px + cell.x] + (word & 1u));
}

// By depth, then by side.
#define COMES_BEFORE(a, b) \
  a.depth_m < b.depth_m || (a.depth_m == b.depth_m && a.near_side < b.near_side)
#define SORTED_TYPE ListNode
#define SORTED nodes
#include "renderers/ray_bundles/shaders/shell_sort.glsl"

bool looks_on(ListNode node) { return (node.near_side & 1u) != 0u; }

bool are_back_to_back(ListNode a, ListNode b) {
  const float kParallel = -0.99999;
  return dot(texels[a.near_side >> 1].xyz, texels[b.near_side >> 1].xyz) < kParallel;
}

bool are_duplicates(ListNode a, ListNode b) {
  return looks_on(a) == looks_on(b) &&
         floatBitsToUint(texels[a.near_side >> 1].w) == floatBitsToUint(texels[b.near_side >> 1].w);
}

// Of two triangles back to back the one that looks back comes first.
void order_run(uint begin, uint end) {
  for (uint i = begin + 1u; i < end; ++i) {
    for (uint j = i; j > begin; --j) {
      ListNode before = nodes[j - 1u];
      ListNode here = nodes[j];
      if (!looks_on(before) || looks_on(here) || !are_back_to_back(before, here)) break;
      nodes[j - 1u] = here;
      nodes[j] = before;
    }
  }
}

void main() {
  uint line = thread_index();
  if (line >= line_count) return;
  uint begin = starts[line];
  uint end = starts[line + 1u];
  if (is_counted != 0 && counts[line] != 0u) {
    atomicAdd(faults, 1u);
    counts[line] = 0u;
    return;
  }
  vec2 center_px = vec2(int(line) % width_px, first_row + int(line) / width_px) + 0.5;
  for (uint i = begin; i < end; ++i) nodes[i] = node_of(words[i], center_px);
  sort(begin, end);

  uint kept = begin;
  for (uint run = begin; run < end;) {
    uint run_end = run + 1u;
    while (run_end < end && nodes[run_end].depth_m - nodes[run_end - 1u].depth_m < tie_m) ++run_end;
    if (run_end - run > 1u) order_run(run, run_end);
    uint first = kept;
    for (uint i = run; i < run_end; ++i) {
      ListNode node = nodes[i];
      if (kept > first && are_duplicates(nodes[kept - 1u], node)) continue;
      nodes[kept++] = node;
    }
    run = run_end;
  }
  if (are_loops_cut_off()) atomicAdd(unordered, 1u);
  counts[line] = kept - begin;
}
