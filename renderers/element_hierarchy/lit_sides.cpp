#include "renderers/element_hierarchy/lit_sides.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::element_hierarchy {

namespace {

using ray_tracing::SampleSequence;
using ray_tracing::SequenceKind;
using ray_tracing::SurfacePoint;

constexpr std::uint64_t kSeed = 0x51de;
/// Rays that must meet lit sides.
constexpr std::size_t kEnough = 2;
/// Of a side's rays at least this share, as one over it, where there are many.
constexpr std::size_t kLeastShare = 256;
constexpr std::size_t kLampRays = 8;  ///< towards area lights

class SideSearch {
 public:
  SideSearch(const ray_tracing::RayScene& rays, std::size_t rays_per_side)
      : rays_(rays),
        count_(rays_per_side),
        lights_(rays),
        areas_(rays, ray_tracing::LightSet::hittable) {
    assert(count_ >= kLampRays);
    const scene::Scene& scene = rays.scene();
    for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
      found_.first.push_back(object_of_.size());
      object_of_.resize(object_of_.size() + scene.objects[object].mesh->triangles.size(), object);
    }
    lit_.assign(2 * object_of_.size(), 0);
    seen_.assign(lit_.size() * count_, kNoSide);
  }

  LitSides run() {
    base::parallel_for(object_of_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t triangle = begin; triangle < end; ++triangle) {
        for (const std::size_t back : {0U, 1U}) look_around(triangle, back == 1);
      }
    });
    spread();
    for (const std::uint8_t is_lit : lit_) found_.is_lit.push_back(is_lit != 0);
    found_.rays = seen_.size();
    found_.rays_per_side = count_;
    found_.seen = std::move(seen_);
    return std::move(found_);
  }

 private:
  void look_around(std::size_t triangle, bool is_back) {
    const std::uint32_t object = object_of_[triangle];
    const auto index = static_cast<std::uint32_t>(triangle - found_.first[object]);
    if (!(rays_.triangle_area_m2(object, index) > 0.0F)) return;
    const std::size_t side = 2 * triangle + (is_back ? 1 : 0);
    const SurfacePoint middle = rays_.point_on_triangle(object, index, {1.0F / 3.0F, 1.0F / 3.0F});
    const glm::vec3 normal = is_back ? -middle.geometric_normal : middle.geometric_normal;
    const auto material = static_cast<std::size_t>(middle.material);
    if (!is_back && rays_.scene().materials[material].is_emissive()) lit_[side] = 1;
    if (sees_point_light(middle, normal)) lit_[side] = 1;
    const std::uint64_t seed = ray_tracing::hash_combine(kSeed, side);
    const ray_tracing::Frame3 frame = ray_tracing::frame_around(normal);
    std::size_t lamps = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const glm::vec4 u =
          SampleSequence(SequenceKind::sobol, seed, static_cast<std::uint32_t>(i)).next();
      const SurfacePoint from =
          rays_.point_on_triangle(object, index, ray_tracing::uniform_triangle({u.z, u.w}));
      if (i < kLampRays && lit_[side] == 0 && sees_area_light(from, normal, glm::vec3(u))) {
        if (++lamps == kEnough) lit_[side] = 1;
      }
      const glm::vec3 direction = frame.to_world(ray_tracing::cosine_hemisphere({u.x, u.y}));
      ray_tracing::LineHit hit;
      if (rays_.nearest(ray_from(from, direction), hit)) {
        seen_[side * count_ + i] = static_cast<std::uint32_t>(
            2 * (found_.first[hit.object] + hit.triangle) + (hit.looks_back ? 0 : 1));
      } else if (rays_.scene().environment) {
        lit_[side] = 1;
      }
    }
  }

  bool sees_point_light(const SurfacePoint& point, const glm::vec3& normal) const {
    for (const scene::Light& light : rays_.scene().lights) {
      const auto sample = lights_.sample_point_light(light, point);
      if (!sample || sample->radiance == glm::vec3(0.0F)) continue;
      if (glm::dot(sample->direction, normal) <= 0.0F) continue;
      if (!rays_.is_occluded(sample->shadow_ray)) return true;
    }
    return false;
  }

  bool sees_area_light(const SurfacePoint& point, const glm::vec3& normal,
                       const glm::vec3& u) const {
    if (areas_.is_empty()) return false;
    const auto sample = areas_.sample(point, u);
    if (!sample || sample->radiance == glm::vec3(0.0F)) return false;
    if (glm::dot(sample->direction, normal) <= 0.0F) return false;
    return !rays_.is_occluded(sample->shadow_ray);
  }

  /// Until nothing changes; the result does not depend on the order.
  void spread() {
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (std::size_t side = 0; side < lit_.size(); ++side) {
        if (lit_[side] != 0) continue;
        std::size_t met = 0;
        for (std::size_t i = 0; i < count_; ++i) {
          const std::uint32_t other = seen_[side * count_ + i];
          if (other != kNoSide && lit_[other] != 0) ++met;
        }
        if (met < std::max(kEnough, count_ / kLeastShare)) continue;
        lit_[side] = 1;
        has_changed = true;
      }
    }
  }

  const ray_tracing::RayScene& rays_;
  std::size_t count_;  ///< rays per side
  ray_tracing::LightSampler lights_;
  ray_tracing::LightSampler areas_;  ///< and environment
  LitSides found_;
  std::vector<std::uint32_t> object_of_;  ///< per triangle of all objects
  std::vector<std::uint8_t> lit_;         ///< per side; bytes, as threads write neighbours
  std::vector<std::uint32_t> seen_;       ///< [side][ray]: the side that is met
};

}  // namespace

LitSides find_lit_sides(const ray_tracing::RayScene& rays, std::size_t rays_per_side) {
  return SideSearch(rays, rays_per_side).run();
}

}  // namespace renderers::element_hierarchy
