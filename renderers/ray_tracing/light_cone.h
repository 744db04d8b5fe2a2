#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/scene/scene.h"

/// Directions that a point light (all of them) or a spot light (its outer cone) sends light into.
namespace renderers::ray_tracing {

/// Their solid angle, sr.
inline float solid_angle_sr(const scene::Light& light) {
  if (light.type == scene::LightType::point) return 4.0F * kPi;
  return 2.0F * kPi * (1.0F - std::cos(light.outer_cone_rad));
}

/// Solid angle that at the axis's intensity takes the light's whole flux, sr: the integral of a
/// spot's fall-off over the cosine is half the interval between its cones (`intensity_towards`), so
/// it is that of a hard cone at the mean cosine.
inline double flux_solid_angle_sr(const scene::Light& light) {
  if (light.type == scene::LightType::point) return 4.0 * std::numbers::pi;
  const double mean_cosine = 0.5 * (std::cos(static_cast<double>(light.inner_cone_rad)) +
                                    std::cos(static_cast<double>(light.outer_cone_rad)));
  return 2.0 * std::numbers::pi * (1.0 - mean_cosine);
}

/// One of them, each as probable as any other. @param u  in [0, 1)^2  @return unit length
inline glm::vec3 direction_in_cone(const scene::Light& light, const glm::vec2& u) {
  const float cosine = 1.0F - u.x * solid_angle_sr(light) / (2.0F * kPi);
  const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
  const float azimuth_rad = 2.0F * kPi * u.y;
  return glm::normalize(
      frame_around(light.direction)
          .to_world({sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine}));
}

}  // namespace renderers::ray_tracing
