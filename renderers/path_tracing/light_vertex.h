#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::path_tracing {

/// The first surface that a ray from a point or spot light meets: the end of a light path of one
/// segment, to which surfaces of a camera path are connected.
struct LightVertex {
  ray_tracing::SurfacePoint point;
  glm::vec3 to_light{0.0F};        ///< unit length
  glm::vec3 power{0.0F};           ///< of the ray, W: intensity over its density
  float cosine = 0.0F;             ///< of `to_light` and the geometric normal, above 0
  float pdf = 0.0F;                ///< of the point, 1/m2 of its surface
  float light_probability = 0.0F;  ///< with which `LightSampler::sample` chooses this light
};

/// Draws light vertices: a light by its power, then a direction of its cone, all alike.
///
/// Source: Lafortune and Willems 1993, "Bi-directional Path Tracing", Proc. Compugraphics, and
/// Veach and Guibas 1995, "Bidirectional Estimators for Light Transport",
/// doi:10.1007/978-3-642-87825-1_11; here light paths have one segment.
class LightVertexSampler {
 public:
  /// @param rays, lights  must live as long as this
  LightVertexSampler(const ray_tracing::RayScene& rays, const ray_tracing::LightSampler& lights);

  /// True if no point or spot light sends light.
  bool is_empty() const { return choice_.total() <= 0.0; }

  /// Only if not empty. @param u  in [0, 1)^3: the direction, the choice
  /// @return nothing if the ray is dark or meets nothing
  std::optional<LightVertex> sample(const glm::vec3& u) const;

  /// Density with which `sample` finds a surface point that the light shines on, 1/m2.
  /// @param light     index into Scene::lights
  /// @param to_light  unit length, from the point
  float pdf(std::uint32_t light, const ray_tracing::SurfacePoint& point,
            const glm::vec3& to_light) const;

 private:
  const ray_tracing::RayScene* rays_;
  ray_tracing::PiecewiseDistribution choice_;
  std::vector<float> ray_pdf_;            ///< [light] of a ray in its cone, 1/sr
  std::vector<float> light_probability_;  ///< [light] of `LightSampler::sample`
};

}  // namespace renderers::path_tracing
