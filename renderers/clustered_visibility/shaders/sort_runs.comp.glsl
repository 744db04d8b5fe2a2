// Pass: stable counting sort of the lights of each run by cluster; a thread per run and cluster,
// the last cluster being that of lights without flux.
// In: virtual lights, their clusters. Out: with COPIES lights, flux.w being the cluster (-1: none),
// else their indices.

#include "renderers/many_lights/shaders/virtual_light.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) readonly buffer Assignments { int assignments[]; };
#ifdef COPIES
layout(std430, binding = 5) writeonly buffer Sorted { VirtualLight sorted_lights[]; };
#else
layout(std430, binding = 5) writeonly buffer Members { int members[]; };
#endif

uniform int light_count;
uniform int cluster_count;
uniform int run_count;
#ifdef COPIES
uniform int only_cluster;  // that keeps its flux; -1: all do
#endif

int key_of(int light) {
  int c = assignments[light];
  return c < 0 ? cluster_count : c;
}

void main() {
  int own = int(gl_GlobalInvocationID.x);
  int run = int(gl_WorkGroupID.y);
  if (own > cluster_count) return;
  int first = run * light_count / run_count;
  int end = (run + 1) * light_count / run_count;
  int place = first;
  for (int i = first; i < end; ++i) place += key_of(i) < own ? 1 : 0;
  for (int i = first; i < end; ++i) {
    if (key_of(i) != own) continue;
#ifdef COPIES
    VirtualLight light = lights[i];
    light.flux.w = own == cluster_count ? -1.0 : float(own);
    if (only_cluster >= 0 && own != only_cluster) {
      light.flux = vec4(0.0, 0.0, 0.0, -1.0);
      light.position.w = 0.0;
    }
    sorted_lights[place] = light;
#else
    members[place] = i;
#endif
    ++place;
  }
}
