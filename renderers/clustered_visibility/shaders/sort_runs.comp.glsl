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

int is_below(int i, int end, int own) { return i < end && key_of(i) < own ? 1 : 0; }

// Light i to its place if it is in the cluster. @return how many were put
int put(int i, int end, int own, int place) {
  if (i >= end || key_of(i) != own) return 0;
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
  return 1;
}

void main() {
  int own = int(gl_GlobalInvocationID.x);
  int run = int(gl_WorkGroupID.y);
  if (own > cluster_count) return;
  int first = run * light_count / run_count;
  int end = (run + 1) * light_count / run_count;
  // Four lights a turn: Mesa's software drivers end a thread's loops after 65,535 turns in all.
  int place = first;
  for (int i = first; i < end; i += 4) {
    place += is_below(i, end, own) + is_below(i + 1, end, own) + is_below(i + 2, end, own) +
             is_below(i + 3, end, own);
  }
  for (int i = first; i < end; i += 4) {
    place += put(i, end, own, place);
    place += put(i + 1, end, own, place);
    place += put(i + 2, end, own, place);
    place += put(i + 3, end, own, place);
  }
}
