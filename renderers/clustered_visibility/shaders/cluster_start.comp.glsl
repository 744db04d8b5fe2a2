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

void main() {
  if (is_warm == 0) {
    for (int i = int(gl_LocalInvocationID.x); i < light_count; i += LOCAL_SIZE) {
      assignments[i] = kFree;
    }
  }
  memoryBarrierBuffer();
  barrier();
  if (gl_LocalInvocationID.x != 0u) return;
  bool is_found = true;
  for (int k = 0; k < cluster_count; ++k) {
    if (is_warm == 1 && centers[k].position.w > 0.0) continue;
    int i = start_light(k);
    // Where one search found no light the next ones cannot either.
    int tried = is_found ? 0 : light_count;
    while (tried < light_count && (lights[i].position.w == 0.0 || assignments[i] >= 0)) {
      i = (i + 1) % light_count;
      ++tried;
    }
    is_found = tried < light_count;
    if (is_found) assignments[i] = k;
    centers[k].position = is_found ? lights[i].position : vec4(0.0);
    centers[k].normal = is_found ? vec4(lights[i].geometric_normal.xyz, 0.0) : vec4(0.0);
  }
}
