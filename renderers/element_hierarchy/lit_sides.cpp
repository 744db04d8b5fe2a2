#include "renderers/element_hierarchy/lit_sides.h"

#include <deque>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::element_hierarchy {

namespace {

using ray_tracing::Hit;
using ray_tracing::Ray;
using ray_tracing::SampleSequence;
using ray_tracing::SequenceKind;

constexpr std::uint64_t kSeed = 0x51de;

/// Uniform over the sphere. @param u  in [0, 1)^2
glm::vec3 sphere_direction(const glm::vec2& u) {
  const float z = 1.0F - 2.0F * u.x;
  const float radius = std::sqrt(std::fmax(0.0F, 1.0F - z * z));
  const float azimuth_rad = 2.0F * ray_tracing::kPi * u.y;
  return {radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z};
}

class SideSearch {
 public:
  SideSearch(const ray_tracing::RayScene& rays, int rays_per_side)
      : rays_(rays), count_(static_cast<std::uint32_t>(rays_per_side)) {
    found_.of_object.resize(rays.scene().objects.size(), {false, false});
  }

  LitSides run() {
    const scene::Scene& scene = rays_.scene();
    for (const scene::Light& light : scene.lights) follow_light(light);
    for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
      const auto material = static_cast<std::size_t>(scene.objects[object].material);
      if (scene.materials[material].is_emissive()) add(object, false);
      if (!scene.environment) continue;
      for (const bool is_back : {false, true}) {
        if (sees_environment(object, is_back)) add(object, is_back);
      }
    }
    while (!open_.empty()) {
      const auto [object, is_back] = open_.front();
      open_.pop_front();
      follow_side(object, is_back);
    }
    return found_;
  }

 private:
  struct Side {
    std::uint32_t object;
    bool is_back;
  };

  void add(std::uint32_t object, bool is_back) {
    bool& is_lit = found_.of_object[object][is_back ? 1 : 0];
    if (is_lit) return;
    is_lit = true;
    open_.push_back({object, is_back});
  }

  /// @return false if the ray leaves the scene
  bool follow(const Ray& ray) {
    ++found_.rays;
    Hit hit;
    if (!rays_.intersect(ray, hit)) return false;
    add(hit.object, glm::dot(hit.geometric_normal, ray.direction) > 0.0F);
    return true;
  }

  void follow_light(const scene::Light& light) {
    for (std::uint32_t i = 0; i < count_; ++i) {
      const glm::vec4 u = SampleSequence(SequenceKind::sobol, kSeed, i).next();
      const glm::vec3 direction = sphere_direction({u.x, u.y});
      if (scene::intensity_towards(light, direction) == glm::vec3(0.0F)) continue;
      follow({light.position, direction});
    }
  }

  Ray ray_of_side(std::uint32_t object, bool is_back, std::uint32_t index,
                  const ray_tracing::PiecewiseDistribution& triangles) const {
    SampleSequence numbers(SequenceKind::sobol,
                           ray_tracing::hash_combine(kSeed + 1, 2 * object + (is_back ? 1 : 0)),
                           index);
    const glm::vec4 u = numbers.next();
    const auto choice = triangles.choose(numbers.next().x);
    const auto point = rays_.point_on_triangle(object, static_cast<std::uint32_t>(choice.index),
                                               ray_tracing::uniform_triangle({u.z, u.w}));
    const glm::vec3 normal = is_back ? -point.geometric_normal : point.geometric_normal;
    return ray_from(point, ray_tracing::frame_around(normal).to_world(
                               ray_tracing::cosine_hemisphere({u.x, u.y})));
  }

  ray_tracing::PiecewiseDistribution areas_of(std::uint32_t object) const {
    std::vector<double> areas;
    const std::size_t count = rays_.scene().objects[object].mesh->triangles.size();
    for (std::uint32_t i = 0; i < count; ++i) {
      areas.push_back(static_cast<double>(rays_.triangle_area_m2(object, i)));
    }
    return ray_tracing::PiecewiseDistribution(areas);
  }

  void follow_side(std::uint32_t object, bool is_back) {
    const auto triangles = areas_of(object);
    if (triangles.total() <= 0.0) return;
    for (std::uint32_t i = 0; i < count_; ++i) follow(ray_of_side(object, is_back, i, triangles));
  }

  bool sees_environment(std::uint32_t object, bool is_back) {
    const auto triangles = areas_of(object);
    if (triangles.total() <= 0.0) return false;
    for (std::uint32_t i = 0; i < count_; ++i) {
      ++found_.rays;
      if (!rays_.is_occluded(ray_of_side(object, is_back, i, triangles))) return true;
    }
    return false;
  }

  const ray_tracing::RayScene& rays_;
  std::uint32_t count_;
  LitSides found_;
  std::deque<Side> open_;
};

}  // namespace

LitSides find_lit_sides(const ray_tracing::RayScene& rays, int rays_per_side) {
  return SideSearch(rays, rays_per_side).run();
}

}  // namespace renderers::element_hierarchy
