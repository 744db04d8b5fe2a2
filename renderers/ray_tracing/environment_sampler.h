#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/scene/scene.h"

namespace renderers::ray_tracing {

/// Draws directions with a density proportional to the luminance of a latitude-longitude map.
///
/// Rows are chosen by their sum with weight sin(theta), columns within the row; the density is
/// constant over a pixel. A pixel's weight is the mean of the bilinear lookup over it, so that no
/// direction with light has density 0.
/// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed. 2016, Sec. 14.2.4.
class EnvironmentSampler {
 public:
  struct Sample {
    glm::vec3 direction{0.0F};  ///< unit length, world space
    float pdf = 0.0F;           ///< 1/sr; 0: no direction was found
  };

  /// @param environment  must live as long as this
  explicit EnvironmentSampler(const scene::Environment& environment);

  /// Integral of the luminance over the sphere, W/m2 of luminance-weighted radiance.
  double power() const { return power_; }
  /// Only if `power() > 0`. @param u  in [0, 1)^2
  Sample sample(const glm::vec2& u) const;
  /// Density of `sample`, 1/sr. @param direction  unit length, world space
  float pdf(const glm::vec3& direction) const;

 private:
  float solid_angle_density(float cell_probability, float v) const;

  const scene::Environment* environment_;
  PiecewiseDistribution rows_;
  std::vector<PiecewiseDistribution> columns_;  ///< one per row
  double power_ = 0.0;
};

}  // namespace renderers::ray_tracing
