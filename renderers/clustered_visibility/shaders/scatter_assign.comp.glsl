// Pass: every light to its nearest cluster; a thread per light.
// In: virtual lights (world space, m), centres. In, out: assignments, -1 without flux; state.

#include "renderers/many_lights/shaders/virtual_light.glsl"
#include "renderers/clustered_visibility/shaders/cluster_rule.glsl"
#include "renderers/clustered_visibility/shaders/scatter_state.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) buffer Assignments { int assignments[]; };
layout(std430, binding = 5) readonly buffer Centers { Center centers[]; };

uniform int light_count;

int nearest_cluster(vec3 position, vec3 normal) {
  int nearest = -1;
  uint least = 0xffffffffu;
  for (int c = 0; c < cluster_count; ++c) {
    uint d = cluster_distance(position, normal, centers[c].position, centers[c].normal.xyz);
    if (d < least) {
      least = d;
      nearest = c;
    }
  }
  return nearest;
}

void main() {
  int own = int(gl_GlobalInvocationID.x);
  if (own >= light_count || is_settled == 1) return;
  VirtualLight light = lights[own];
  int c = -1;
  if (light.position.w > 0.0) {
    c = nearest_cluster(light.position.xyz, light.geometric_normal.xyz);
  }
  if (c != assignments[own]) atomicAdd(moved, 1);
  assignments[own] = c;
}
