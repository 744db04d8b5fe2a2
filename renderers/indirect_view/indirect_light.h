#pragma once

#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::indirect_view {

/// A surface point as it is looked at; normals are on the viewer's side.
struct ViewedPoint {
  ray_tracing::SurfacePoint surface;
  glm::vec3 geometric_normal{0.0F};  ///< unit length
  glm::vec3 normal{0.0F};            ///< shading normal, unit length
  std::uint64_t seed = 0;            ///< of the random numbers at this point
  std::uint32_t index = 0;           ///< of the sample in the sequences of the seed
};

/// @param to_viewer  any length
inline ViewedPoint viewed_point(const ray_tracing::SurfacePoint& surface,
                                const glm::vec3& to_viewer, std::uint64_t seed,
                                std::uint32_t index) {
  const float side = glm::dot(surface.geometric_normal, to_viewer) < 0.0F ? -1.0F : 1.0F;
  return {surface, side * surface.geometric_normal, side * surface.shading_normal, seed, index};
}

/// What a technique knows of light that surfaces have reflected by their Lambert lobes.
class IndirectLight {
 public:
  virtual ~IndirectLight() = default;

  /// Irradiance from light that was reflected at least once before, W/m2.
  /// @param rays  counts those traced
  virtual glm::vec3 irradiance(const ViewedPoint& point, std::uint64_t& rays) const = 0;
  /// Radiance that a surface reflects by its Lambert lobe, direct and indirect light together,
  /// W/(m2 sr). @param rays  counts those traced
  virtual glm::vec3 reflected(const ViewedPoint& point, std::uint64_t& rays) const = 0;
};

}  // namespace renderers::indirect_view
