#include "renderers/element_hierarchy/known_light.h"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

namespace {

constexpr std::uint64_t kSeed = 0x4e0f;

}  // namespace

KnownLight::KnownLight(const ElementTree& tree, int environment_rays)
    : tree_(tree),
      environment_rays_(environment_rays),
      lights_(tree.rays(), ray_tracing::LightSet::all) {
  const auto& environment = tree.rays().scene().environment;
  if (environment) {
    environment_ = std::make_unique<ray_tracing::EnvironmentSampler>(*environment);
    if (environment_->power() <= 0.0) environment_.reset();
  }
}

bool KnownLight::exists() const { return environment_ || !tree_.rays().scene().lights.empty(); }

KnownLight::Irradiance KnownLight::at(std::uint32_t patch) const {
  const Element& element = tree_.at(patch);
  Irradiance sum;
  if (!tree_.rays().scene().lights.empty()) {
    // Weights of the corners in the middles of the quarters.
    constexpr float kMost = 2.0F / 3.0F;
    constexpr float kLeast = 1.0F / 6.0F;
    constexpr std::array<glm::vec3, 4> kMiddles{{{kMost, kLeast, kLeast},
                                                 {kLeast, kMost, kLeast},
                                                 {kLeast, kLeast, kMost},
                                                 {1.0F / 3.0F, 1.0F / 3.0F, 1.0F / 3.0F}}};
    float least = std::numeric_limits<float>::infinity();
    float greatest = 0.0F;
    for (const glm::vec3& weight : kMiddles) {
      const glm::vec2 place = weight.x * element.corners[0] + weight.y * element.corners[1] +
                              weight.z * element.corners[2];
      const SidePoint point{tree_.rays().point_on_triangle(element.object, element.triangle, place),
                            element.normal, element.root_begin};
      const glm::vec3 light = from_point_lights(point, sum.rays);
      sum.point_lights += 0.25F * light;
      least = std::min(least, ray_tracing::luminance(light));
      greatest = std::max(greatest, ray_tracing::luminance(light));
    }
    sum.spread = 0.5F * (greatest - least);
  }
  if (environment_) sum.environment = from_environment(patch, sum.rays);
  return sum;
}

glm::vec3 KnownLight::from_point_lights(const SidePoint& point, std::uint64_t& rays) const {
  glm::vec3 sum(0.0F);
  for (const scene::Light& light : tree_.rays().scene().lights) {
    const auto sample = lights_.sample_point_light(light, point.surface);
    if (!sample) continue;
    const float cosine = glm::dot(point.normal, sample->direction);
    if (cosine <= 0.0F || sample->radiance == glm::vec3(0.0F)) continue;
    ++rays;
    if (!tree_.rays().is_occluded(sample->shadow_ray)) sum += cosine * sample->radiance;
  }
  return sum;
}

glm::vec3 KnownLight::from_environment(std::uint32_t patch, std::uint64_t& rays) const {
  glm::vec3 sum(0.0F);
  const std::uint64_t seed = ray_tracing::hash_combine(kSeed, patch);
  for (int i = 0; i < environment_rays_; ++i) {
    ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol, seed,
                                        static_cast<std::uint32_t>(i));
    const glm::vec4 u = numbers.next();
    const SidePoint point = tree_.sample(patch, {u.z, u.w});
    const auto drawn = environment_->sample({u.x, u.y});
    const float cosine = glm::dot(point.normal, drawn.direction);
    if (drawn.pdf <= 0.0F || cosine <= 0.0F) continue;
    ++rays;
    if (tree_.rays().is_occluded(ray_from(point.surface, drawn.direction))) continue;
    sum += lights_.environment(drawn.direction) * (cosine / drawn.pdf);
  }
  return sum / static_cast<float>(environment_rays_);
}

}  // namespace renderers::element_hierarchy
