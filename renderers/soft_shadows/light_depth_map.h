#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::soft_shadows {

/// A flat light as a shadow map needs it: a square of the same area about its centre.
struct FlatLight {
  glm::vec3 centre{0.0F};  ///< m, mean of its points
  glm::vec3 normal{0.0F};  ///< unit length, front side
  glm::vec3 tangent{0.0F};
  glm::vec3 bitangent{0.0F};
  float width_m = 0.0F;  ///< sqrt(12 x variance along an axis): the side of a square light

  /// Coordinates along tangent, bitangent and normal from the centre, m.
  glm::vec3 to_light(const glm::vec3& position) const;
};

/// @throws UnsupportedError if the light is not flat: its normals spread by more than 60 degrees
/// @param light  with points
FlatLight flat_light(const ray_tracing::LightPointSet& light);

/// Depths of what a light's centre sees in its front half space, in stereographic projection
/// (x, y) / (1 + z) of unit directions, which keeps small squares square everywhere.
class LightDepthMap {
 public:
  /// One ray per texel within the unit disk, from just in front of the centre.
  /// @param side_px  texels along a side, >= 2
  LightDepthMap(const ray_tracing::RayScene& rays, const FlatLight& light, int side_px);

  /// The first surface towards a place, along the nearest texel's ray, in the light's coordinates;
  /// z is infinite where there is none. @param place  in the light's coordinates, z > 0
  glm::vec3 surface_towards(const glm::vec3& place) const;
  std::size_t ray_count() const { return ray_count_; }
  std::size_t memory_bytes() const { return heights_.size() * sizeof(float); }

 private:
  int side_px_;
  std::size_t ray_count_ = 0;
  std::vector<float> heights_;
};

}  // namespace renderers::soft_shadows
