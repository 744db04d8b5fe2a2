#include "tests/renderers/many_lights/ray_cast_inputs.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/many_lights/halton.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::test {

using many_lights::SurfaceImage;
using many_lights::VirtualLight;
using ray_tracing::Hit;
using ray_tracing::RayScene;

SurfaceImage make_surfaces(int width_px, int height_px) {
  SurfaceImage surfaces;
  surfaces.width_px = width_px;
  surfaces.height_px = height_px;
  const auto count = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  surfaces.position.resize(count, glm::vec4(0.0F));
  surfaces.geometric_normal.resize(count, glm::vec4(0.0F));
  surfaces.shading_normal.resize(count, glm::vec4(0.0F));
  surfaces.albedo.resize(count, glm::vec4(0.0F));
  return surfaces;
}

void put_surface(const scene::Scene& scene, const ray_tracing::SurfacePoint& point,
                 const glm::vec3& to_viewer, SurfaceImage& surfaces, std::size_t pixel) {
  const float side = glm::dot(point.geometric_normal, to_viewer) < 0.0F ? -1.0F : 1.0F;
  const scene::Material& material = scene.materials[static_cast<std::size_t>(point.material)];
  surfaces.position[pixel] = {point.position, 1.0F};
  surfaces.geometric_normal[pixel] = {side * point.geometric_normal,
                                      static_cast<float>(point.material)};
  surfaces.shading_normal[pixel] = {side * point.shading_normal, 0.0F};
  surfaces.albedo[pixel] = {diffuse_albedo(scene, point), material.is_glossy() ? 1.0F : 0.0F};
}

SurfaceImage cast_surfaces(const RayScene& rays, int width_px, int height_px,
                           const glm::vec2& offset_px) {
  SurfaceImage surfaces = make_surfaces(width_px, height_px);
  const ray_tracing::CameraRays camera(rays.scene().camera, width_px, height_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const ray_tracing::Ray ray = camera.through(static_cast<float>(x) + 0.5F + offset_px.x,
                                                  static_cast<float>(y) + 0.5F + offset_px.y);
      Hit hit;
      if (!rays.intersect(ray, hit)) continue;
      put_surface(rays.scene(), hit, -ray.direction, surfaces,
                  static_cast<std::size_t>(y * width_px + x));
    }
  }
  return surfaces;
}

std::vector<VirtualLight> cast_lights(const RayScene& rays, const scene::Light& light, int count) {
  const bool is_spot = light.type == scene::LightType::spot;
  const float least_cosine = is_spot ? std::cos(light.outer_cone_rad) : -1.0F;
  const float solid_angle =
      2.0F * ray_tracing::kPi * (1.0F - least_cosine) / static_cast<float>(count);
  const auto frame = ray_tracing::frame_around(light.direction);
  std::vector<VirtualLight> lights(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto u = static_cast<float>(many_lights::radical_inverse(i + 1, 2));
    const float azimuth =
        2.0F * ray_tracing::kPi * static_cast<float>(many_lights::radical_inverse(i + 1, 3));
    const float cosine = 1.0F - u * (1.0F - least_cosine);
    const float sine = std::sqrt(1.0F - cosine * cosine);
    const glm::vec3 direction =
        frame.to_world({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
    Hit hit;
    if (!rays.intersect({light.position, direction}, hit)) continue;
    const float side = glm::dot(hit.geometric_normal, direction) > 0.0F ? -1.0F : 1.0F;
    VirtualLight& made = lights[i];
    made.position = {hit.position, 1.0F};
    made.geometric_normal = {side * hit.geometric_normal, 0.0F};
    made.shading_normal = {side * hit.shading_normal, 0.0F};
    const float shading = std::fmax(0.0F, -side * glm::dot(hit.shading_normal, direction));
    const float geometric = -side * glm::dot(hit.geometric_normal, direction);
    const glm::vec3 albedo = diffuse_albedo(rays.scene(), hit);
    made.flux = {
        albedo * scene::intensity_towards(light, direction) * (solid_angle * shading / geometric),
        0.0F};
  }
  return lights;
}

VirtualLight light_at(const glm::vec3& position, const glm::vec3& normal, const glm::vec3& flux) {
  return {{position, 1}, {normal, 0}, {normal, 0}, {flux, 0}};
}

glm::vec4 numbers(std::uint64_t seed, std::uint32_t index) {
  return ray_tracing::SampleSequence(ray_tracing::SequenceKind::sobol, seed, index).next();
}

}  // namespace renderers::test
