#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/ray_tracing/environment_sampler.h"
#include "renderers/ray_tracing/light_sampler.h"

namespace renderers::element_hierarchy {

/// Irradiance of patches from what is no element: point and spot lights, and the environment.
class KnownLight {
 public:
  /// @param tree  must live as long as this
  /// @param environment_rays  per patch, >= 1
  KnownLight(const ElementTree& tree, int environment_rays);

  /// True if there is any such light.
  bool exists() const;

  struct Irradiance {
    glm::vec3 point_lights{0.0F};  ///< W/m2, mean over the patch: over the middles of its quarters
    glm::vec3 environment{0.0F};
    float spread = 0.0F;  ///< half the range of the quarters' luminance, point lights
    std::uint64_t rays = 0;
  };
  Irradiance at(std::uint32_t patch) const;

 private:
  glm::vec3 from_point_lights(const SidePoint& point, std::uint64_t& rays) const;
  glm::vec3 from_environment(std::uint32_t patch, std::uint64_t& rays) const;

  const ElementTree& tree_;
  int environment_rays_;
  ray_tracing::LightSampler lights_;
  std::unique_ptr<ray_tracing::EnvironmentSampler> environment_;
};

}  // namespace renderers::element_hierarchy
