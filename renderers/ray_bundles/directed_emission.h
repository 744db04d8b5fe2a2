#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_bundles/light_solution.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// Emission of texels whose material has an emission profile: all lines of a bundle leave a texel
/// at one angle, so that one radiance per texel and direction is exact on a flat one.
///
/// Source: Hermes et al. 2010, Sec. 5.1, where surface light fields are among the sources that
/// bundles carry: all that is needed is their radiance along one direction at a time.
class DirectedEmission {
 public:
  /// Until the first bundle, texels emit their means over all directions.
  /// @param rays, atlas  must live as long as this
  DirectedEmission(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas);

  /// True if no texel has a profile.
  bool is_empty() const { return beams_.empty(); }
  /// Before a bundle. @param direction  of its lines, unit length
  void turn(const glm::vec3& direction);
  /// What texels emit now.
  void apply(LightSolution& solution) const;
  /// The same over the emission of a texel where profiles are 1.
  float factor(std::uint32_t texel) const { return factors_[texel]; }
  std::int64_t memory_bytes() const;

 private:
  const std::vector<float>& profile_of(std::uint32_t texel) const;

  const ray_tracing::RayScene& rays_;
  const texel_atlas::TexelAtlas& atlas_;
  std::vector<std::uint32_t> beams_;  ///< texels with a profile
  std::vector<float> factors_;        ///< per texel
};

}  // namespace renderers::ray_bundles
