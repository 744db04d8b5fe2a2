// The basis of a convolution shadow map at one texel.
// Source: Annen et al. 2007, "Convolution Shadow Maps", EGSR, recalled: sin(c_k z), cos(c_k z),
// c_k = pi (2k - 1); Annen et al. 2008, "Real-Time, All-Frequency Shadows in Dynamic Scenes",
// recalled: the same times z, and z itself, for the mean depth of blockers.
// Needs the defines TERMS (K) and GROUPS (ceil(K / 4)): four terms to a texel.

#include "renderers/clustered_visibility/shaders/area_light.glsl"

layout(std430, binding = 7) readonly buffer AreaLights { AreaLight area_lights[]; };
layout(binding = 0) uniform usampler2DArray distances;  // bits of m, infinity where there is nothing

uniform float far_depth;

// Depth of a texel: distance in the units of its layer, that of the far end where there is nothing.
float depth_at(ivec2 texel, int layer) {
  float distance_m = uintBitsToFloat(texelFetch(distances, ivec3(texel, layer), 0).r);
  return isinf(distance_m) ? far_depth : min(distance_m * area_lights[layer].shape.y, far_depth);
}

bool is_empty_layer(int layer) { return area_lights[layer].position.w == 0.0; }

// The two vectors of a quantity: sines and cosines of four terms, times z where WEIGHTED; with DEPTH
// z alone; with MOMENTS the first four powers of 2 z - 1 alone (Peters and Klein 2015).
void basis_at(float z, int group, out vec4 first, out vec4 second) {
#ifdef MOMENTS
  float signed_z = 2.0 * z - 1.0;
  float square = signed_z * signed_z;
  first = vec4(signed_z, square, signed_z * square, square * square);
  second = vec4(0.0);
#elif defined(DEPTH)
  first = vec4(z, 0.0, 0.0, 0.0);
  second = vec4(0.0);
#else
  vec4 k = float(4 * group) + vec4(1.0, 2.0, 3.0, 4.0);
  vec4 angle = 3.14159265358979 * (2.0 * k - 1.0) * z;
  vec4 is_term = vec4(lessThanEqual(k, vec4(float(TERMS))));
  first = is_term * sin(angle);
  second = is_term * cos(angle);
#ifdef WEIGHTED
  first *= z;
  second *= z;
#endif
#endif
}
