#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "renderers/indirect_view/indirect_light.h"
#include "renderers/ray_tracing/light_sampler.h"

namespace renderers::irradiance_cache {

/// Radiance that surfaces reflect by their Lambert lobes, by one path: a sample on the lights at
/// each surface and one cosine-distributed ray to the next.
///
/// Source: Kajiya 1986, "The Rendering Equation", doi:10.1145/15922.15902; Arvo and Kirk 1990,
/// doi:10.1145/97879.97886 (Russian roulette).
class BounceLight {
 public:
  /// @param rays   must live as long as this
  /// @param depth  most surfaces of a path, >= 1; 0: no bound
  BounceLight(const ray_tracing::RayScene& rays, int depth);

  /// W/(m2 sr), from the point towards its viewer. @param cast  counts the rays
  glm::vec3 reflected(const indirect_view::ViewedPoint& point, std::uint64_t& cast) const;

 private:
  const ray_tracing::RayScene& rays_;
  int depth_;
  ray_tracing::LightSampler lights_;
};

}  // namespace renderers::irradiance_cache
