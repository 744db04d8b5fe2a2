#pragma once

#include <glm/vec4.hpp>

/// One-bounce light from many virtual point lights (Keller 1997, "Instant Radiosity",
/// doi:10.1145/258734.258769; Dachsbacher and Stamminger 2005, "Reflective Shadow Maps",
/// doi:10.1145/1053427.1053460).
namespace renderers::many_lights {

/// A virtual point light: a small piece of lit Lambert surface that sends flux into the hemisphere
/// it was lit from. std430, `VirtualLight` of shaders/virtual_light.glsl; `position` and
/// `geometric_normal` lead, so that shadow maps can read them (stride 4 vec4).
///
/// Irradiance it gives to a receiver at distance d along w (from the receiver, unit length):
///   E = flux / pi  max(0, n_x . w) max(0, n_g . -w) / d^2  min(1, b / G)  V,
///   G = (n_x . w) |n_s . -w| / d^2,   n_x the receiver's shading normal, b the geometry clamp,
/// and nothing if w is below the receiver's geometric horizon.
struct VirtualLight {
  glm::vec4 position{0.0F};          ///< xyz, m; w: 1, or 0: no light here, to be skipped
  glm::vec4 geometric_normal{0.0F};  ///< xyz, unit length, on the lit side; w: 0 (no clip height)
  glm::vec4 shading_normal{0.0F};    ///< xyz, unit length, on the same side
  /// rgb, W: reflected flux. Flux that arrives x albedo x cos_s / cos_g, the cosines at the light's
  /// direction by shading and geometric normal (1 on flat surfaces).
  glm::vec4 flux{0.0F};
};

}  // namespace renderers::many_lights
