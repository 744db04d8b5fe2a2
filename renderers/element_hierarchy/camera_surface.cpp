#include "renderers/element_hierarchy/camera_surface.h"

#include "renderers/ray_tracing/point_light_shading.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

using ray_tracing::Hit;

glm::vec3 CameraSurface::point_lights(const Hit& hit, const glm::vec3& to_viewer,
                                      std::uint64_t& rays) const {
  return reflected_point_lights(
      rays_, lights_, hit, make_brdf(rays_.scene(), hit, to_viewer, ray_tracing::Lobes::all), rays);
}

CameraSurface::Light CameraSurface::glossy(const Hit& hit, const glm::vec3& to_viewer,
                                           const glm::vec4& u) const {
  Light light;
  ray_tracing::SurfaceBrdf lobe = make_brdf(rays_.scene(), hit, to_viewer, ray_tracing::Lobes::all);
  lobe.diffuse = glm::vec3(0.0F);
  lobe.glossy_share = 1.0F;
  const ray_tracing::BrdfSample drawn = sample(lobe, 0.0F, {u.x, u.y});
  if (drawn.value == glm::vec3(0.0F)) return light;
  const glm::vec3 weight = drawn.value / drawn.pdf;
  light.rays = 1;
  Hit seen;
  if (!rays_.intersect(ray_from(hit, drawn.direction), seen)) {
    light.direct = weight * environment(drawn.direction);
    return light;
  }
  light.direct = weight * emission(seen, -drawn.direction);
  if (shown_ != nullptr) light.indirect = weight * shown_->reflected(seen, -drawn.direction);
  return light;
}

CameraSurface::Light CameraSurface::all(const Hit& hit, const glm::vec3& to_viewer,
                                        const glm::vec4& u) const {
  Light light;
  const auto material = static_cast<std::size_t>(hit.material);
  if (rays_.scene().materials[material].is_glossy()) light = glossy(hit, to_viewer, u);
  light.direct += emission(hit, to_viewer) + point_lights(hit, to_viewer, light.rays);
  return light;
}

}  // namespace renderers::element_hierarchy
