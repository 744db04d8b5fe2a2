#include "renderers/indirect_view/sampled_light.h"

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::indirect_view {

glm::vec3 sampled_light(const ray_tracing::RayScene& rays, const ray_tracing::LightSampler& lights,
                        const ViewedPoint& point, const glm::vec3& u, std::uint64_t& cast) {
  if (lights.is_empty()) return glm::vec3(0.0F);
  const auto light = lights.sample(point.surface, u);
  if (!light) return glm::vec3(0.0F);
  const float cosine = glm::dot(point.normal, light->direction);
  if (cosine <= 0.0F || glm::dot(point.geometric_normal, light->direction) <= 0.0F) {
    return glm::vec3(0.0F);
  }
  ++cast;
  if (rays.is_occluded(light->shadow_ray)) return glm::vec3(0.0F);
  return light->radiance * (cosine / light->pdf);
}

glm::vec3 reflectance_of(const ray_tracing::RayScene& rays, const ViewedPoint& point) {
  return ray_tracing::diffuse_albedo(rays.scene(), point.surface) * (1.0F / ray_tracing::kPi);
}

}  // namespace renderers::indirect_view
