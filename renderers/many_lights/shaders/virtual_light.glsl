// A virtual point light and what it gives to a receiver; VirtualLight of virtual_light.h.
// Needs the define WITH_CLAMP where the geometry term is bounded.

struct VirtualLight {
  vec4 position;          // xyz, m; w: 1, or 0: no light
  vec4 geometric_normal;  // unit length, on the lit side
  vec4 shading_normal;    // unit length, on the same side
  vec4 flux;              // rgb, W, reflected
};

const float kPi = 3.14159265358979;
const float kLeastDistance2 = 1e-30;  // m2

// Irradiance that a light of flux pi gives, without visibility:
//   max(0, n_x . w) max(0, n_g . -w) / d^2  min(1, b / G),
//   G = (n_x . w) |n_s . -w| / d^2;  w to the light, d its distance
// (Dachsbacher and Stamminger 2005, Eq. 1, with unit vectors; clamp: Keller 1997). Zero below the
// receiver's geometric horizon.
// to_light: from the receiver, m, any length; geometry_clamp: b, 1/m2, > 0.
float light_geometry(vec3 to_light, vec3 geometric_normal, vec3 shading_normal, VirtualLight light,
                     float geometry_clamp) {
  precise float receiver = max(dot(shading_normal, to_light), 0.0);           // d cos
  precise float emitter = max(-dot(light.geometric_normal.xyz, to_light), 0.0);  // d cos
  float is_above = dot(geometric_normal, to_light) > 0.0 ? light.position.w : 0.0;
  // Without branches; the bound keeps the factor finite where light and receiver coincide.
  precise float inverse_distance2 = 1.0 / max(dot(to_light, to_light), kLeastDistance2);
  precise float receiver_part = receiver * inverse_distance2;
  precise float value = is_above * receiver_part * (emitter * inverse_distance2);
#ifdef WITH_CLAMP
  precise float geometry =
      receiver_part * (abs(dot(light.shading_normal.xyz, to_light)) * inverse_distance2);
  value *= geometry_clamp / max(geometry, geometry_clamp);
#endif
  return value;
}
