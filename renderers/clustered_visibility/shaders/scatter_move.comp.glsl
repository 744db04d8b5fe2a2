// Pass: centres to the means of their lights; empty clusters keep theirs. One work group.
// In: sums. In, out: centres, state. Out: summary.

#include "renderers/clustered_visibility/shaders/cluster_rule.glsl"
#include "renderers/clustered_visibility/shaders/scatter_state.glsl"

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D sums;
layout(std430, binding = 5) buffer Centers { Center centers[]; };
layout(std430, binding = 6) buffer Summary {
  int iterations;
  int has_converged;
  int filled;
};

uniform vec3 bounds_min;  // m
uniform int is_first;     // 1: the first iteration

void main() {
  if (is_settled == 1) return;
  bool has_moved = moved > 0;
  barrier();
  for (int c = int(gl_LocalInvocationID.x); c < cluster_count; c += 64) {
    vec4 place = texelFetch(sums, ivec2(c, 0), 0);
    vec3 direction = texelFetch(sums, ivec2(c, 1), 0).xyz;
    centers[c].normal.w = place.w;
    if (place.w == 0.0 || !has_moved) continue;
    centers[c].position.xyz = bounds_min + place.xyz / place.w;
    if (length(direction) / place.w >= kShortestMean) {
      centers[c].normal.xyz = normalize(direction);
    }
  }
  if (gl_LocalInvocationID.x != 0u) return;
  iterations = is_first == 1 ? 1 : iterations + 1;
  has_converged = has_moved ? 0 : 1;
  is_settled = has_moved ? 0 : 1;
  filled = 0;
  for (int c = 0; c < cluster_count; ++c) filled += texelFetch(sums, ivec2(c, 0), 0).w > 0.0 ? 1 : 0;
  moved = 0;
}
