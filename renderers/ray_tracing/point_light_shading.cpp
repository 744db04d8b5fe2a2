#include "renderers/ray_tracing/point_light_shading.h"

#include <optional>

namespace renderers::ray_tracing {

glm::vec3 reflected_point_lights(const RayScene& rays, const LightSampler& lights,
                                 const SurfacePoint& point, const SurfaceBrdf& brdf,
                                 std::uint64_t& shadow_rays) {
  glm::vec3 sum(0.0F);
  for (const scene::Light& light : rays.scene().lights) {
    const std::optional<LightSample> sample = lights.sample_point_light(light, point);
    if (!sample) continue;
    const glm::vec3 reflected = evaluate(brdf, sample->direction) * sample->radiance;
    if (reflected == glm::vec3(0.0F)) continue;
    ++shadow_rays;
    if (!rays.is_occluded(sample->shadow_ray)) sum += reflected;
  }
  return sum;
}

}  // namespace renderers::ray_tracing
