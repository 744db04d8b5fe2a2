#include "renderers/light_propagation/reflective_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/devices.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::light_propagation {

namespace {

constexpr std::size_t kRayGrain = 256;
constexpr int kFewestPoints = 4;

/// Directions of equal solid angle within a cone.
class ConeSpiral {
 public:
  ConeSpiral(const glm::vec3& axis, double cosine, int count) : axis_(axis), count_(count) {
    height_ = 1.0 - cosine;
    const glm::vec3 aside = std::abs(axis.y) < 0.9F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    tangent_ = glm::normalize(glm::cross(aside, axis));
    bitangent_ = glm::cross(axis, tangent_);
  }
  double solid_angle_sr() const { return 2.0 * std::numbers::pi * height_ / count_; }
  glm::vec3 direction(std::size_t index) const {
    const double place = static_cast<double>(index) + 0.5;
    const double z = 1.0 - height_ * place / count_;
    const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    // The golden angle.
    const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0)) * static_cast<double>(index);
    return static_cast<float>(radius * std::cos(turn)) * tangent_ +
           static_cast<float>(radius * std::sin(turn)) * bitangent_ + static_cast<float>(z) * axis_;
  }

 private:
  glm::vec3 axis_;
  glm::vec3 tangent_{0.0F};
  glm::vec3 bitangent_{0.0F};
  double height_ = 0.0;  ///< of the cap
  int count_;
};

ConeSpiral spiral_of(const scene::Light& light, int count) {
  if (light.type == scene::LightType::point) return {glm::vec3(0, 1, 0), -1.0, count};
  return {light.direction, std::cos(static_cast<double>(light.outer_cone_rad)), count};
}

struct Texel {
  SurfaceSample sample;
  ReflectedFlux flux;
};

std::optional<Texel> texel_of(const ray_tracing::RayScene& rays, const scene::Light& light,
                              const glm::vec3& direction, float solid_angle_sr) {
  ray_tracing::Ray ray;
  ray.origin = light.position;
  ray.direction = direction;
  ray_tracing::Hit hit;
  if (!rays.intersect(ray, hit)) return std::nullopt;
  const glm::vec3 reflected = scene::intensity_towards(light, direction) * solid_angle_sr *
                              ray_tracing::diffuse_albedo(rays.scene(), hit);
  Texel texel;
  texel.sample.point = hit;
  const bool is_front = glm::dot(hit.geometric_normal, direction) < 0.0F;
  (is_front ? texel.flux.front : texel.flux.back) = reflected;
  return texel;
}

}  // namespace

ReflectiveMap reflective_map(const ray_tracing::RayScene& rays, int rays_per_light) {
  if (!ray_tracing::make_light_points(rays, kFewestPoints, 1).empty()) {
    throw UnsupportedError(
        "light-propagation: sources=rsm takes point and spot lights; area lights and environments "
        "need sources=poisson");
  }
  ReflectiveMap map;
  for (const scene::Light& light : rays.scene().lights) {
    const ConeSpiral spiral = spiral_of(light, rays_per_light);
    const auto solid_angle = static_cast<float>(spiral.solid_angle_sr());
    std::vector<std::optional<Texel>> texels(static_cast<std::size_t>(rays_per_light));
    base::parallel_for(texels.size(), kRayGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        texels[i] = texel_of(rays, light, spiral.direction(i), solid_angle);
      }
    });
    for (const auto& texel : texels) {
      if (!texel) continue;
      map.samples.push_back(texel->sample);
      map.light.samples.push_back(texel->flux);
    }
    map.light.rays += static_cast<std::uint64_t>(rays_per_light);
  }
  return map;
}

}  // namespace renderers::light_propagation
