// Pass: the lights that clusters start from.
// In: virtual lights. Out: centres, every light in no cluster (assignments -2, which is no result).
// is_warm: centres and assignments of the last call stay; centres that had no light to start from
// take lights that are in no cluster yet.
// Source: Dong et al. 2009, Sec. 6: light k N / M. START_PREFIX: light k (ours). A light without
// flux, or taken already, is replaced by the next one that is neither.

#include "renderers/many_lights/shaders/virtual_light.glsl"
#include "renderers/clustered_visibility/shaders/cluster_rule.glsl"

layout(local_size_x = LOCAL_SIZE) in;

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) coherent buffer Assignments { int assignments[]; };
layout(std430, binding = 5) buffer Centers { Center centers[]; };

uniform int light_count;
uniform int is_warm;  // 0 or 1

const int kFree = -2;

int start_light(int k) {
#ifdef START_PREFIX
  return k;
#else
  return k * light_count / cluster_count;
#endif
}

// Lights that may be taken, a bit each: they have flux and are in no cluster.
shared uint free_lights[(MOST_LIGHTS + 31) / 32];
// Lights from `first` on, cyclically, that are known not to be free.
int first = 0;
int taken = 0;

void find_free_lights() {
  for (int word = int(gl_LocalInvocationID.x); word * 32 < light_count; word += LOCAL_SIZE) {
    uint bits = 0u;
    for (int i = word * 32; i < min(word * 32 + 32, light_count); ++i) {
      if (lights[i].position.w != 0.0 && assignments[i] < 0) bits |= 1u << (i & 31);
    }
    free_lights[word] = bits;
  }
}

// The first free light at or after `start`, cyclically, which then is taken; -1: none. Starts that
// never go back never look at a light twice, so that loops stay short whatever is dark.
int take_light(int start) {
  if ((start - first + light_count) % light_count >= taken) {
    first = start;
    taken = 0;
  }
  while (taken < light_count) {
    int i = (first + taken) % light_count;
    uint bits = free_lights[i >> 5] >> (i & 31);
    if (bits == 0u) {
      taken += min(32 - (i & 31), light_count - i);
      continue;
    }
    int skipped = findLSB(bits);
    i += skipped;
    taken += skipped + 1;
    free_lights[i >> 5] &= ~(1u << (i & 31));
    return i;
  }
  return -1;
}

void main() {
  if (is_warm == 0) {
    for (int i = int(gl_LocalInvocationID.x); i < light_count; i += LOCAL_SIZE) {
      assignments[i] = kFree;
    }
  }
  memoryBarrierBuffer();
  barrier();
  find_free_lights();
  barrier();
  if (gl_LocalInvocationID.x != 0u) return;
  for (int k = 0; k < cluster_count; ++k) {
    if (is_warm == 1 && centers[k].position.w > 0.0) continue;
    int i = take_light(start_light(k));
    if (i >= 0) assignments[i] = k;
    centers[k].position = i >= 0 ? lights[i].position : vec4(0.0);
    centers[k].normal = i >= 0 ? vec4(lights[i].geometric_normal.xyz, 0.0) : vec4(0.0);
  }
}
