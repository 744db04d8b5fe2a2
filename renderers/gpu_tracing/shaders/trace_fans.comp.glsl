// Pass: which of up to 16 targets are hidden from a point, a ray to each.
// In: fans (point, m; first of its targets; bit per target that is asked for), targets (xyz: point,
// m, or direction; w: the ray's end, a share of the way to a point, infinite for a direction),
// the scene's triangles. Out: occluded, per fan a bit per target; progress, per ray the node it
// stands at; unfinished, the number of rays that have not come to their end.
// Source: see bvh.glsl.

#include "renderers/gpu_tracing/shaders/bvh.glsl"

layout(local_size_x = 64) in;

const uint kTargets = 16u;

struct Fan {
  float origin[3];
  uint first_target;
  uint asked;
};

layout(std430, binding = 0) readonly buffer Fans { Fan fans[]; };
layout(std430, binding = 1) readonly buffer Targets { vec4 targets[]; };
layout(std430, binding = 2) buffer Occluded { uint occluded[]; };
layout(std430, binding = 3) buffer Progress { uint progress[]; };
layout(std430, binding = 4) buffer Unfinished { uint unfinished; };

uniform uint fan_count;
uniform uint most_boxes;

bool bvh_stops_at(BvhHit hit) { return true; }

void main() {
  uint index = gl_GlobalInvocationID.x;
  uint fan_index = index / kTargets;
  uint bit = index % kTargets;
  if (fan_index >= fan_count) return;
  uint asked = fans[fan_index].asked;
  if ((asked >> bit & 1u) == 0u) return;
  uint node = progress[index];
  if (node >= bvh_node_count) return;
  vec4 target = targets[fans[fan_index].first_target + bit];
  BvhRay ray;
  ray.origin = vec3(fans[fan_index].origin[0], fans[fan_index].origin[1],
                    fans[fan_index].origin[2]);
  // The CPU's rays to the bit.
  precise vec3 to_target = target.xyz - ray.origin;
  ray.direction = isinf(target.w) ? target.xyz : to_target;
  ray.t_max = target.w;
  if (bvh_walk(ray, most_boxes, node)) {
    atomicOr(occluded[fan_index], 1u << bit);
    node = bvh_node_count;
  }
  progress[index] = node;
  if (node < bvh_node_count) atomicAdd(unfinished, 1u);
}
