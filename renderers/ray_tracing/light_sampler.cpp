#include "renderers/ray_tracing/light_sampler.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/light_cone.h"
#include "renderers/ray_tracing/surface_brdf.h"
#include "renderers/scene/emission_profile.h"

namespace renderers::ray_tracing {

namespace {

const scene::Material& material_of(const scene::Scene& scene, std::uint32_t object) {
  return scene.materials[static_cast<std::size_t>(scene.objects[object].material)];
}

glm::vec3 mean_of(const scene::Texture& texture) {
  glm::dvec3 sum(0.0);
  const perception::Image& image = texture.image;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const auto pixel = image.pixel(x, y);
      sum += glm::dvec3(pixel[0], pixel[1], pixel[2]);
    }
  }
  return glm::vec3(sum / static_cast<double>(image.pixel_count()));
}

/// Luminance of the emitted radiance, its mean over texture and projected directions.
double mean_emission(const scene::Scene& scene, const scene::Material& material) {
  glm::vec3 emission = material.emission;
  if (material.emission_texture != scene::kNoTexture) {
    emission *= mean_of(scene.textures[static_cast<std::size_t>(material.emission_texture)]);
  }
  return static_cast<double>(luminance(emission)) * scene::flux_factor(material.emission_profile);
}

/// Flux of a light over all directions, luminance-weighted.
double power_of(const scene::Light& light) {
  return flux_solid_angle_sr(light) * static_cast<double>(luminance(light.intensity));
}

/// Area of a disk around the scene, m2; 1 for a scene without triangles.
double disk_area_m2(const RayScene& rays) {
  if (rays.triangle_count() == 0) return 1.0;
  const double diameter_m = static_cast<double>(glm::distance(rays.box_min(), rays.box_max()));
  return 0.25 * std::numbers::pi * diameter_m * diameter_m;
}

/// One given light, written where it is wanted.
/// @return false if the point lies on the light
bool find_point_light(const scene::Light& light, const SurfacePoint& from,
                      std::optional<LightSample>& sample) {
  const glm::vec3 to_light = light.position - from.position;
  const float distance2 = glm::dot(to_light, to_light);
  if (distance2 <= 0.0F) return false;
  const glm::vec3 direction = to_light / std::sqrt(distance2);
  LightSample& found = sample.emplace();
  found.direction = direction;
  found.radiance = scene::intensity_towards(light, -direction) / distance2;
  found.pdf = 1.0F;
  found.is_delta = true;
  found.shadow_ray = segment_to(from, light.position);
  return true;
}

}  // namespace

LightSampler::LightSampler(const RayScene& rays, LightSet set) : rays_(&rays) {
  const scene::Scene& scene = rays.scene();
  std::vector<double> powers;
  for (const scene::Light& light : scene.lights) {
    powers.push_back(set == LightSet::all ? power_of(light) : 0.0);
  }
  area_pdf_.resize(scene.objects.size());
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    if (material_of(scene, object).is_emissive()) add_triangles(object, powers);
  }
  can_be_hit_ = !triangles_.empty();
  if (scene.environment) {
    environment_.emplace(*scene.environment);
    powers.push_back(environment_->power() * disk_area_m2(rays));
    can_be_hit_ = true;
  }
  choice_ = PiecewiseDistribution(powers);
  if (choice_.total() <= 0.0) return;

  if (environment_) environment_probability_ = choice_.probability(powers.size() - 1);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const EmissiveTriangle& t = triangles_[i];
    const float probability = choice_.probability(scene.lights.size() + i);
    const float area_m2 = rays.triangle_area_m2(t.object, t.triangle);
    if (area_m2 > 0.0F) area_pdf_[t.object][t.triangle] = probability / area_m2;
  }
}

void LightSampler::add_triangles(std::uint32_t object, std::vector<double>& powers) {
  const scene::Scene& scene = rays_->scene();
  const double emission = mean_emission(scene, material_of(scene, object));
  const std::size_t count = scene.objects[object].mesh->triangles.size();
  area_pdf_[object].resize(count);
  for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
    triangles_.push_back({object, triangle});
    const auto area_m2 = static_cast<double>(rays_->triangle_area_m2(object, triangle));
    powers.push_back(std::numbers::pi * area_m2 * emission);
  }
}

std::optional<LightSample> LightSampler::sample(const SurfacePoint& from,
                                                const glm::vec3& u) const {
  const scene::Scene& scene = rays_->scene();
  const auto chosen = choice_.choose(u.x);
  std::optional<LightSample> sample;  // the one that is returned: written in its place
  float probability = chosen.probability;
  if (chosen.index < scene.lights.size()) {
    if (find_point_light(scene.lights[chosen.index], from, sample)) {
      sample->light = static_cast<std::uint32_t>(chosen.index);
    }
  } else if (chosen.index < scene.lights.size() + triangles_.size()) {
    const EmissiveTriangle& light = triangles_[chosen.index - scene.lights.size()];
    sample = sample_triangle(light, from, {u.y, u.z});
    probability = 1.0F;  // is in its density
  } else {
    sample = sample_environment(from, {u.y, u.z});
  }
  if (sample) sample->pdf *= probability;
  return sample;
}

std::optional<LightSample> LightSampler::sample_point_light(const scene::Light& light,
                                                            const SurfacePoint& from) const {
  std::optional<LightSample> sample;
  find_point_light(light, from, sample);
  return sample;
}

std::optional<LightSample> LightSampler::sample_triangle(const EmissiveTriangle& light,
                                                         const SurfacePoint& from,
                                                         const glm::vec2& u) const {
  const SurfacePoint point =
      rays_->point_on_triangle(light.object, light.triangle, uniform_triangle(u));
  const glm::vec3 to_light = point.position - from.position;
  const float distance_m = glm::length(to_light);
  if (distance_m <= 0.0F) return std::nullopt;
  LightSample sample;
  sample.direction = to_light / distance_m;
  sample.pdf = pdf_of_emission(point, sample.direction, distance_m);
  sample.radiance = emission(point, -sample.direction);
  if (sample.pdf <= 0.0F) return std::nullopt;
  sample.shadow_ray = segment_to(from, point);
  return sample;
}

std::optional<LightSample> LightSampler::sample_environment(const SurfacePoint& from,
                                                            const glm::vec2& u) const {
  const EnvironmentSampler::Sample drawn = environment_->sample(u);
  if (drawn.pdf <= 0.0F) return std::nullopt;
  LightSample sample;
  sample.direction = drawn.direction;
  sample.radiance = environment(drawn.direction);
  sample.pdf = drawn.pdf;
  sample.shadow_ray = ray_from(from, drawn.direction);
  return sample;
}

glm::vec3 LightSampler::emission(const SurfacePoint& point, const glm::vec3& direction) const {
  if (area_pdf_[point.object].empty()) return glm::vec3(0.0F);
  const float cosine = glm::dot(point.geometric_normal, direction);
  if (cosine <= 0.0F) return glm::vec3(0.0F);
  return emitted_radiance(rays_->scene(), point, cosine);
}

glm::vec3 LightSampler::environment(const glm::vec3& direction) const {
  const scene::Scene& scene = rays_->scene();
  if (!scene.environment) return glm::vec3(0.0F);
  return scene::sample_environment(*scene.environment, direction);
}

float LightSampler::pdf_of_emission(const SurfacePoint& light, const glm::vec3& direction,
                                    float distance_m) const {
  if (area_pdf_[light.object].empty()) return 0.0F;
  const float cosine = -glm::dot(light.geometric_normal, direction);
  if (cosine <= 0.0F) return 0.0F;
  return area_pdf_[light.object][light.triangle] * distance_m * distance_m / cosine;
}

float LightSampler::pdf_of_environment(const glm::vec3& direction) const {
  return environment_ && environment_probability_ > 0.0F
             ? environment_probability_ * environment_->pdf(direction)
             : 0.0F;
}

}  // namespace renderers::ray_tracing
