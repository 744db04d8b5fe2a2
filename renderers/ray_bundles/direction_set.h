#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_bundles/direction_importance.h"

namespace renderers::ray_bundles {

/// Where the directions of bundles come from. A line and its reverse are the same bundle, so points
/// of the whole sphere serve as well as those of a hemisphere.
enum class DirectionKind {
  /// Halton points in their order (the paper, Sec. 4.3). One direction fixes the next: what
  /// multiplies light of successive directions stays wrong for ever.
  halton,
  /// The same, shuffled inside blocks that end at powers of two, at multiples of 1024, and at the
  /// planned number: every such beginning is a beginning of the Halton sequence. Ours.
  halton_permuted,
  hammersley,  ///< complete sets only; in order
  fibonacci,   ///< spherical Fibonacci points, shuffled; complete sets only
  iid          ///< independent
};

/// One bundle of parallel lines.
struct BundleDirection {
  glm::vec3 direction{0.0F, 0.0F, 1.0F};  ///< unit length
  float roll_rad = 0.0F;                  ///< of the raster about the direction, in [0, 2 pi)
  glm::vec2 jitter_px{0.0F};              ///< of the raster, in [0, 1)^2
  /// What the bundle counts: the uniform density over its own, 1 / (2 pi p).
  float weight = 1.0F;
};

/// The directions of a picture, uniform over lines, or a share of them by importance.
///
/// With the share s of density q the rest is uniform, and each direction weighs the uniform density
/// over the mixture's, 1 / (1 - s + 4 pi s q): at most 1 / (1 - s), and 1 in the mean. Source:
/// Hermes et al. 2010, Eq. 2, whose p is any density; Hesterberg 1995, "Weighted Average Importance
/// Sampling and Defensive Mixture Distributions", doi:10.1080/00401706.1995.10484303.
///
/// Points are rotated by the seed (Cranley and Patterson 1976, "Randomization of Number Theoretic
/// Methods for Multiple Integration", doi:10.1137/0713071); roll and jitter are independent random
/// numbers, so that the raster leaves no pattern.
class DirectionSet {
 public:
  /// @param planned   how many there will be; 0: not known, the complete sets then hold 1024
  /// @param set_size  of complete sets, whose beginning alone is used if it is above `planned`; 0:
  ///                  as many as planned
  DirectionSet(DirectionKind kind, std::uint64_t seed, std::int64_t planned,
               std::int64_t set_size = 0);

  /// From here on. @param share  s, in [0, 1); an empty importance leaves all directions uniform
  void set_importance(DirectionImportance importance, double share);

  /// @param index  from 0; any, but cheapest in order
  BundleDirection at(std::int64_t index);

 private:
  glm::dvec2 point(std::int64_t index);
  std::int64_t shuffled(std::int64_t index);

  DirectionKind kind_;
  std::uint64_t seed_;
  std::int64_t planned_;
  std::int64_t set_size_;
  std::optional<DirectionImportance> importance_;
  double share_ = 0.0;
  std::int64_t block_begin_ = 0;
  std::vector<std::int64_t> block_;  ///< a permutation of [block_begin_, block_begin_ + size)
};

/// Source: Shirley's equal-area map of the square to the sphere: z = 1 - 2 u, phi = 2 pi v.
glm::vec3 direction_on_sphere(const glm::dvec2& point);

}  // namespace renderers::ray_bundles
