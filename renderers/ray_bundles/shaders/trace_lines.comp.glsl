// Pass: counts the crossings of every line, or with FILL writes them into the lines' lists, by a
// walk through the scene's hierarchy of boxes that no hit ends; a thread per line. No box and no
// triangle is met twice, wherever a walk is interrupted.
// In: the scene's triangles (bvh.glsl; `triangle` counts as bundle_triangles.glsl does), frame;
// with FILL, starts of the lists. In, out: counts per line, which FILL brings to 0; progress, the
// node that each line stands at. Out: number of lines that have not come to their end; with FILL,
// words as of bundle_fill.frag.glsl.
// Source: see bvh.glsl; all hits of a ray as in Gribble, Wald, Amstutz 2016, JCGT 5(4), of which
// this is the plain variant.

#include "renderers/gpu_tracing/shaders/bvh.glsl"
#include "renderers/ray_bundles/shaders/bundle_frame.glsl"
#include "renderers/ray_bundles/shaders/thread_index.glsl"

layout(std430, binding = 0) buffer Unfinished { uint unfinished; };
layout(std430, binding = 1) buffer Progress { uint progress[]; };
layout(std430, binding = 2) buffer Counts { uint counts[]; };
layout(std430, binding = 3) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 4) writeonly buffer Words { uint words[]; };

uniform uint line_count;
uniform uint most_boxes;
uniform int width_px;
uniform int first_row;
uniform float line_m;  // length of a line

uint count = 0u;  // so far; with FILL, those that are left
#ifdef FILL
uint list_begin = 0u;
uint list_length = 0u;
#endif

bool bvh_stops_at(BvhHit hit) {
#ifdef FILL
  --count;
  // Was not counted: order_lines.comp.glsl finds the count beyond 0.
  if (count < list_length) words[list_begin + count] = 2u * hit.triangle + uint(!hit.looks_back);
#else
  ++count;
#endif
  return false;
}

void main() {
  uint line = thread_index();
  if (line >= line_count) return;
  uint node = progress[line];
  if (node >= bvh_node_count) return;
  count = counts[line];
#ifdef FILL
  list_begin = starts[line];
  list_length = starts[line + 1u] - list_begin;
#endif
  vec2 center_px = vec2(int(line) % width_px, first_row + int(line) / width_px) + 0.5;
  // The CPU's lines to the bit.
  precise vec2 offset_m = center_px * pixel_m;
  precise vec3 origin = corner + offset_m.x * axis_x + offset_m.y * axis_y;
  bvh_walk(BvhRay(origin, direction, line_m), most_boxes, node);
  counts[line] = count;
  progress[line] = node;
  if (node < bvh_node_count) atomicAdd(unfinished, 1u);
}
