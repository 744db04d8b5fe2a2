#include "renderers/photon_map/photon_emission.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/light_cone.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::photon_map {

namespace {

using ray_tracing::kPi;
using ray_tracing::luminance;
using ray_tracing::solid_angle_sr;

/// Luminance of the emission at a triangle's middle and corners, its mean over them and over
/// projected directions.
double mean_emission(const ray_tracing::RayScene& rays, std::uint32_t object,
                     std::uint32_t triangle) {
  const glm::vec2 places[]{{1.0F / 3.0F, 1.0F / 3.0F}, {0.1F, 0.1F}, {0.8F, 0.1F}, {0.1F, 0.8F}};
  float sum = 0.0F;
  for (const glm::vec2& place : places) {
    sum +=
        luminance(unshaped_emission(rays.scene(), rays.point_on_triangle(object, triangle, place)));
  }
  // A texture may be dark in these places alone: no part of an emitter has probability 0.
  const scene::Material& material =
      rays.scene().materials[static_cast<std::size_t>(rays.scene().objects[object].material)];
  return static_cast<double>(0.25F * sum + 0.05F * luminance(material.emission)) *
         scene::flux_factor(material.emission_profile);
}

}  // namespace

PhotonEmission::PhotonEmission(const ray_tracing::RayScene& rays) : rays_(&rays) {
  const scene::Scene& scene = rays.scene();
  std::vector<double> powers;
  for (const scene::Light& light : scene.lights) {
    powers.push_back(static_cast<double>(solid_angle_sr(light) * luminance(light.intensity)));
  }
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const auto material = static_cast<std::size_t>(scene.objects[object].material);
    if (!scene.materials[material].is_emissive()) continue;
    const auto count = static_cast<std::uint32_t>(scene.objects[object].mesh->triangles.size());
    for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
      triangles_.push_back({object, triangle});
      powers.push_back(std::numbers::pi * mean_emission(rays, object, triangle) *
                       static_cast<double>(rays.triangle_area_m2(object, triangle)));
    }
  }
  if (rays.triangle_count() > 0) {
    middle_ = 0.5F * (rays.box_min() + rays.box_max());
    radius_m_ = 0.5F * glm::distance(rays.box_min(), rays.box_max());
  }
  if (scene.environment) {
    environment_.emplace(*scene.environment);
    powers.push_back(environment_->power() * static_cast<double>(kPi * radius_m_ * radius_m_));
  }
  choice_ = ray_tracing::PiecewiseDistribution(powers);
}

std::optional<EmittedPhoton> PhotonEmission::emit(const glm::vec4& place,
                                                  const glm::vec2& turn) const {
  const scene::Scene& scene = rays_->scene();
  const auto chosen = choice_.choose(place.z);
  std::optional<EmittedPhoton> photon;
  if (chosen.index < scene.lights.size()) {
    photon = from_light(scene.lights[chosen.index], turn);
  } else if (chosen.index < scene.lights.size() + triangles_.size()) {
    photon = from_triangle(triangles_[chosen.index - scene.lights.size()], glm::vec2(place), turn);
  } else {
    photon = from_environment(glm::vec2(place), turn);
  }
  if (!photon) return std::nullopt;
  photon->power /= chosen.probability;
  if (photon->power == glm::vec3(0.0F)) return std::nullopt;
  return photon;
}

EmittedPhoton PhotonEmission::from_light(const scene::Light& light, const glm::vec2& turn) const {
  EmittedPhoton photon;
  photon.ray.origin = light.position;
  photon.ray.direction = ray_tracing::direction_in_cone(light, turn);
  photon.power = scene::intensity_towards(light, photon.ray.direction) * solid_angle_sr(light);
  return photon;
}

EmittedPhoton PhotonEmission::from_triangle(const EmissiveTriangle& triangle,
                                            const glm::vec2& place, const glm::vec2& turn) const {
  const ray_tracing::SurfacePoint point = rays_->point_on_triangle(
      triangle.object, triangle.triangle, ray_tracing::uniform_triangle(place));
  const ray_tracing::Frame3 frame = ray_tracing::frame_around(point.geometric_normal);
  const glm::vec3 direction = ray_tracing::cosine_hemisphere(turn);
  EmittedPhoton photon;
  photon.ray = ray_from(point, glm::normalize(frame.to_world(direction)));
  photon.power = emitted_radiance(rays_->scene(), point, direction.z) *
                 (kPi * rays_->triangle_area_m2(triangle.object, triangle.triangle));
  return photon;
}

std::optional<EmittedPhoton> PhotonEmission::from_environment(const glm::vec2& place,
                                                              const glm::vec2& turn) const {
  const ray_tracing::EnvironmentSampler::Sample drawn = environment_->sample(turn);
  if (drawn.pdf <= 0.0F) return std::nullopt;
  const float radius_m = radius_m_ * std::sqrt(place.x);
  const float azimuth_rad = 2.0F * kPi * place.y;
  const ray_tracing::Frame3 frame = ray_tracing::frame_around(drawn.direction);
  EmittedPhoton photon;
  // Twice the radius away: outside of the sphere, wherever on the disk.
  photon.ray.origin =
      middle_ + frame.to_world({radius_m * std::cos(azimuth_rad), radius_m * std::sin(azimuth_rad),
                                2.0F * radius_m_});
  photon.ray.direction = -drawn.direction;
  photon.power = scene::sample_environment(*rays_->scene().environment, drawn.direction) *
                 (kPi * radius_m_ * radius_m_ / drawn.pdf);
  return photon;
}

}  // namespace renderers::photon_map
