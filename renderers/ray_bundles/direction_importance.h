#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// A density over the lines' directions, constant in cells of equal solid angle.
///
/// A line and its reverse are the same bundle: the density of both is the same.
class DirectionImportance {
 public:
  static constexpr std::size_t kRows = 64;      ///< in z
  static constexpr std::size_t kColumns = 128;  ///< in azimuth; even
  static constexpr std::size_t kCells = kRows * kColumns;

  /// Which cell a direction lies in. @param direction  unit length
  static std::size_t cell_of(const glm::vec3& direction);

  /// @param weights  kCells of them, finite, >= 0, of directions; each counts for its reverse, too
  explicit DirectionImportance(std::span<const double> weights);

  /// True if all weights are 0: there is no density.
  bool is_empty() const { return rows_.total() <= 0.0; }
  /// Over the sphere, 1/sr; the same for the reverse. @param direction  unit length
  double density(const glm::vec3& direction) const;
  /// A direction by `density`; only if not empty. @param u  in [0, 1)^2
  glm::vec3 sample(const glm::dvec2& u) const;

 private:
  ray_tracing::PiecewiseDistribution rows_;
  std::vector<ray_tracing::PiecewiseDistribution> columns_;  ///< one per row
};

/// What bundles have to carry, before the first of them.
struct CarriedLight {
  /// Per side: emitted, and of known direct light reflected; the same in all directions, of
  /// emission profiles the mean: lines along a beam are not asked for more often than across it.
  std::vector<glm::vec3> radiance;
  bool has_environment = false;  ///< bundles carry its light
  std::uint64_t seed = 1;
};

/// Where light comes from that bundles have to carry, by walks from its senders.
///
/// Light of radiance L that meets a surface under the cosine c has the second moment (c L)^2 in the
/// sum over directions (Hermes et al. 2010, Eq. 3); the variance over all surfaces is least for
///
///   p(w) ~ sqrt(S(w)),  S(w) = integral of (c L)^2 over the surfaces that w lights,
///
/// by the inequality of Cauchy and Schwarz. S is measured by rays from the senders: by area times
/// radiance and cosine, each counting c L where it arrives; of the environment by its luminance,
/// with the mean c of convex surfaces, 1/2, on the projected area of the scene's box.
///
/// Source: what Hermes et al. 2010, Sec. 7, leave to the future, "importance-based sampling of
/// directions"; the density is ours.
/// @param rays, atlas  of the same scene
DirectionImportance measure_importance(const ray_tracing::RayScene& rays,
                                       const texel_atlas::TexelAtlas& atlas,
                                       const CarriedLight& light);

}  // namespace renderers::ray_bundles
