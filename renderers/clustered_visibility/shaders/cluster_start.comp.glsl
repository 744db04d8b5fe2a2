// Pass: the lights that clusters start from.
// In: virtual lights. Out: centres, every light in no cluster (assignments -2, which is no result).
// Source: Dong et al. 2009, Sec. 6: light k N / M. START_PREFIX: light k (ours). A light without
// flux, or taken already, is replaced by the next one that is neither.

#include "renderers/many_lights/shaders/virtual_light.glsl"
#include "renderers/clustered_visibility/shaders/cluster_rule.glsl"

layout(local_size_x = LOCAL_SIZE) in;

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) coherent buffer Assignments { int assignments[]; };
layout(std430, binding = 5) buffer Centers { Center centers[]; };

uniform int light_count;

const int kFree = -2;

int start_light(int k) {
#ifdef START_PREFIX
  return k;
#else
  return k * light_count / cluster_count;
#endif
}

void main() {
  for (int i = int(gl_LocalInvocationID.x); i < light_count; i += LOCAL_SIZE) {
    assignments[i] = kFree;
  }
  memoryBarrierBuffer();
  barrier();
  if (gl_LocalInvocationID.x != 0u) return;
  for (int k = 0; k < cluster_count; ++k) {
    int i = start_light(k);
    int tried = 0;
    while (tried < light_count && (lights[i].position.w == 0.0 || assignments[i] != kFree)) {
      i = (i + 1) % light_count;
      ++tried;
    }
    bool is_found = tried < light_count;
    if (is_found) assignments[i] = k;
    centers[k].position = is_found ? lights[i].position : vec4(0.0);
    centers[k].normal = is_found ? vec4(lights[i].geometric_normal.xyz, 0.0) : vec4(0.0);
  }
}
