// Pass: iterations of k-means of virtual lights, in one work group; nothing once they have settled.
// In: virtual lights (world space, m), centres of the start or of the last pass. In, out: cluster of
// each light, -1 without flux. Out: centres, summary.
// Source: Dong et al. 2009, Sec. 5. Sums are integers, so that their order does not matter:
// positions in the scene's bounds and normals times `fixed_scale`.

#include "renderers/many_lights/shaders/virtual_light.glsl"
#include "renderers/clustered_visibility/shaders/cluster_rule.glsl"

layout(local_size_x = LOCAL_SIZE) in;

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) buffer Assignments { int assignments[]; };
layout(std430, binding = 5) buffer Centers { Center centers[]; };
layout(std430, binding = 6) buffer Summary {
  int iterations;
  int has_converged;
  int filled;
};

uniform int light_count;
uniform int earlier_iterations;  // of passes before this one
uniform int most_iterations;     // of this pass
uniform vec3 bounds_min;      // m
uniform float bounds_size;    // m, longest side
uniform float fixed_scale;

shared vec4 center_position[CLUSTERS];
shared vec3 center_normal[CLUSTERS];
shared int sums[CLUSTERS * 7];  // position, normal, number
shared int moved;

int nearest_cluster(vec3 position, vec3 normal) {
  int nearest = -1;
  uint least = 0xffffffffu;
  for (int c = 0; c < cluster_count; ++c) {
    uint d = cluster_distance(position, normal, center_position[c], center_normal[c]);
    if (d < least) {
      least = d;
      nearest = c;
    }
  }
  return nearest;
}

void add_to_sums(int c, vec3 position, vec3 normal) {
  ivec3 place = ivec3(round((position - bounds_min) / bounds_size * fixed_scale));
  ivec3 direction = ivec3(round(normal * fixed_scale));
  for (int i = 0; i < 3; ++i) {
    atomicAdd(sums[c * 7 + i], place[i]);
    atomicAdd(sums[c * 7 + 3 + i], direction[i]);
  }
  atomicAdd(sums[c * 7 + 6], 1);
}

// Every light to its nearest cluster; sums over clusters.
void assign_lights() {
  for (int i = int(gl_LocalInvocationID.x); i < light_count; i += LOCAL_SIZE) {
    VirtualLight light = lights[i];
    int c = -1;
    if (light.position.w > 0.0) {
      c = nearest_cluster(light.position.xyz, light.geometric_normal.xyz);
      if (c >= 0) add_to_sums(c, light.position.xyz, light.geometric_normal.xyz);
    }
    if (c != assignments[i]) atomicAdd(moved, 1);
    assignments[i] = c;
  }
}

void clear_sums() {
  for (int i = int(gl_LocalInvocationID.x); i < cluster_count * 7; i += LOCAL_SIZE) sums[i] = 0;
  if (gl_LocalInvocationID.x == 0u) moved = 0;
}

// Centres are means; empty clusters keep theirs.
void move_centers() {
  for (int c = int(gl_LocalInvocationID.x); c < cluster_count; c += LOCAL_SIZE) {
    int count = sums[c * 7 + 6];
    if (count == 0) continue;
    vec3 place = vec3(sums[c * 7], sums[c * 7 + 1], sums[c * 7 + 2]) / float(count);
    vec3 mean = vec3(sums[c * 7 + 3], sums[c * 7 + 4], sums[c * 7 + 5]) / float(count);
    center_position[c].xyz = bounds_min + place / fixed_scale * bounds_size;
    float size = length(mean) / fixed_scale;
    if (size >= kShortestMean) center_normal[c] = normalize(mean);
  }
}

void main() {
  if (earlier_iterations > 0 && has_converged != 0) return;
  int own = int(gl_LocalInvocationID.x);
  for (int c = own; c < cluster_count; c += LOCAL_SIZE) {
    center_position[c] = centers[c].position;
    center_normal[c] = centers[c].normal.xyz;
  }
  int iteration = 0;
  bool is_settled = false;
  while (iteration < most_iterations && !is_settled) {
    clear_sums();
    barrier();
    assign_lights();
    ++iteration;
    memoryBarrierShared();
    barrier();
    is_settled = moved == 0;
    // After the last one too: a warm start goes on from there.
    if (!is_settled) move_centers();
    barrier();
  }
  for (int c = own; c < cluster_count; c += LOCAL_SIZE) {
    centers[c].position = center_position[c];
    centers[c].normal = vec4(center_normal[c], float(sums[c * 7 + 6]));
  }
  if (own == 0) {
    iterations = earlier_iterations + iteration;
    has_converged = is_settled ? 1 : 0;
    filled = 0;
    for (int c = 0; c < cluster_count; ++c) filled += sums[c * 7 + 6] > 0 ? 1 : 0;
  }
}
