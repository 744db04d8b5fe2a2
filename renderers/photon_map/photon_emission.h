#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/ray_tracing/environment_sampler.h"
#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::photon_map {

/// A photon on its way from a light.
struct EmittedPhoton {
  ray_tracing::Ray ray;
  glm::vec3 power{0.0F};  ///< W, if it were the only one; to be divided by their number
};

/// Draws photons from all lights of a scene, each light's share by its power, so that photons
/// carry nearly the same power: point lights over all directions, spots over their cone, emissive
/// triangles by area and cosine, the environment over a disk around the scene. Factors of emission
/// profiles are the photons': of a narrow beam few are heavy, most have no power and are dropped.
///
/// Source: Jensen 1996, "Global Illumination using Photon Maps", Rendering Techniques '96,
/// doi:10.1007/978-3-7091-7484-5_3, Sec. 2.1.
class PhotonEmission {
 public:
  /// @param rays  must live as long as this, with its scene
  explicit PhotonEmission(const ray_tracing::RayScene& rays);

  /// True if no light emits anything.
  bool is_empty() const { return choice_.total() <= 0.0; }
  /// Only if not empty. @param place  in [0, 1)^4: x, y on the light, z the choice of the light
  /// @param turn  in [0, 1)^2: the direction
  /// @return nothing for a direction or place without light
  std::optional<EmittedPhoton> emit(const glm::vec4& place, const glm::vec2& turn) const;

 private:
  struct EmissiveTriangle {
    std::uint32_t object;
    std::uint32_t triangle;
  };
  EmittedPhoton from_light(const scene::Light& light, const glm::vec2& turn) const;
  EmittedPhoton from_triangle(const EmissiveTriangle& triangle, const glm::vec2& place,
                              const glm::vec2& turn) const;
  std::optional<EmittedPhoton> from_environment(const glm::vec2& place,
                                                const glm::vec2& turn) const;

  const ray_tracing::RayScene* rays_;
  ray_tracing::PiecewiseDistribution choice_;  ///< lights, triangles, environment
  std::vector<EmissiveTriangle> triangles_;
  std::optional<ray_tracing::EnvironmentSampler> environment_;
  glm::vec3 middle_{0.0F};  ///< of the scene's bounding sphere
  float radius_m_ = 0.0F;
};

}  // namespace renderers::photon_map
