// How near a light is to a cluster, and which cluster is the nearest.
// Source: Dong et al. 2009, Sec. 5.1: d = w_x dx + w_a dalpha. Units ours: dx in diagonals of the
// scene's bounds, dalpha in half turns.

struct Center {
  vec4 position;  // m; w: 1, or 0 if there was no light to start from: never the nearest
  vec4 normal;    // unit length; w: number of lights
};

// Mean normals shorter than this say nothing: the normals cancel out (ours).
const float kShortestMean = 0.1;

uniform float position_weight;  // per metre
uniform float normal_weight;    // per half turn
uniform int cluster_count;

// Steps of distances: what differs by less is a tie, whatever a device's square roots are like.
const float kSteps = 4194304.0;  // 2^22

// acos(x) / pi, absolute error 1e-8 before rounding.
// Source: Abramowitz and Stegun 1964, Handbook of Mathematical Functions, 4.4.46.
float half_turns(float x) {
  precise float a = min(abs(x), 1.0);
  precise float p = -0.0012624911;
  p = p * a + 0.0066700901;
  p = p * a - 0.0170881256;
  p = p * a + 0.0308918810;
  p = p * a - 0.0501743046;
  p = p * a + 0.0889789874;
  p = p * a - 0.2145988016;
  p = p * a + 1.5707963050;
  precise float angle = sqrt(1.0 - a) * p * 0.318309886183791;
  return x < 0.0 ? 1.0 - angle : angle;
}

uint cluster_distance(vec3 position, vec3 normal, vec4 center, vec3 center_normal) {
  precise vec3 apart = position - center.xyz;
  precise float distance2 = dot(apart, apart);
  precise float cosine = dot(normal, center_normal);
  precise float d =
      position_weight * sqrt(distance2) + normal_weight * half_turns(cosine);
  return center.w > 0.0 ? uint(min(d * kSteps + 0.5, 4.0e9)) : 0xffffffffu;
}
