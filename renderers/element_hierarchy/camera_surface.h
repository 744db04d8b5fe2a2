#pragma once

#include <cstdint>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/element_hierarchy/shown_light.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::element_hierarchy {

/// Light at surfaces that the camera sees which is not a matter of the Lambert lobe and links:
/// emission, environment, point and spot lights, and the glossy lobe.
class CameraSurface {
 public:
  struct Light {
    glm::vec3 direct{0.0F};    ///< radiance towards the camera
    glm::vec3 indirect{0.0F};  ///< radiance towards the camera
    std::uint64_t rays = 0;
  };

  /// @param shown  null: light reaches no surface
  CameraSurface(const ray_tracing::RayScene& rays, const ShownLight* shown)
      : rays_(rays), shown_(shown), lights_(rays) {}

  /// What a ray that meets nothing sees.
  glm::vec3 environment(const glm::vec3& direction) const { return lights_.environment(direction); }
  /// @param to_viewer  unit length
  glm::vec3 emission(const ray_tracing::Hit& hit, const glm::vec3& to_viewer) const {
    return lights_.emission(hit, to_viewer);
  }
  /// Point and spot lights, by one shadow ray each, by the whole BRDF.
  glm::vec3 point_lights(const ray_tracing::Hit& hit, const glm::vec3& to_viewer,
                         std::uint64_t& rays) const;
  /// The glossy lobe, by one ray along it into the solution. @param u  its random numbers
  Light glossy(const ray_tracing::Hit& hit, const glm::vec3& to_viewer, const glm::vec4& u) const;
  /// All of these together; nothing of the Lambert lobe but point lights.
  Light all(const ray_tracing::Hit& hit, const glm::vec3& to_viewer, const glm::vec4& u) const;

 private:
  const ray_tracing::RayScene& rays_;
  const ShownLight* shown_;
  ray_tracing::LightSampler lights_;
};

}  // namespace renderers::element_hierarchy
