#pragma once

#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

/// Radiant intensity as two bands of spherical harmonics, W/sr: coefficients of Y00, then of the
/// band with x, y, z. One sign for all: the linear ones are positive along their axis.
namespace renderers::light_propagation {

inline constexpr float kY0 = 0.28209479F;  ///< 1 / (2 sqrt(pi))
inline constexpr float kY1 = 0.48860251F;  ///< sqrt(3 / (4 pi))

/// Basis functions in a direction of unit length.
inline glm::vec4 basis(const glm::vec3& direction) { return {kY0, kY1 * direction}; }

/// Projection of the clamped cosine, whose flux is pi: sqrt(pi) / 2 and sqrt(pi / 3). Ramamoorthi
/// and Hanrahan 2001, doi:10.1145/383259.383317 (number recalled), in two bands.
inline constexpr float kCosine0 = 0.88622693F;
inline constexpr float kCosine1 = 1.02332671F;

/// The cosine about a normal.
inline glm::vec4 cosine_lobe(const glm::vec3& normal) { return {kCosine0, kCosine1 * normal}; }

/// Intensity in a direction.
inline float intensity(const glm::vec4& lobe, const glm::vec3& direction) {
  return glm::dot(lobe, basis(direction));
}

/// Flux over all directions: 2 sqrt(pi) c00.
inline float flux(const glm::vec4& lobe) { return 3.54490770F * lobe.x; }

}  // namespace renderers::light_propagation
