#include "renderers/irradiance_cache/bounce_light.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "renderers/indirect_view/sampled_light.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::irradiance_cache {

namespace {

using indirect_view::ViewedPoint;
using ray_tracing::kPi;

/// Surfaces of a path before roulette may end it, and the greatest share that goes on. Ours.
constexpr int kFirstRoulette = 2;
constexpr float kGreatestSurvival = 0.95F;

}  // namespace

BounceLight::BounceLight(const ray_tracing::RayScene& rays, int depth)
    : rays_(rays), depth_(depth), lights_(rays) {}

glm::vec3 BounceLight::reflected(const ViewedPoint& point, std::uint64_t& cast) const {
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, point.seed, point.index);
  ViewedPoint at = point;
  glm::vec3 weight(1.0F);
  glm::vec3 sum(0.0F);
  for (int surface = 1;; ++surface) {
    const glm::vec3 reflectance = reflectance_of(rays_, at);
    if (reflectance == glm::vec3(0.0F)) return sum;
    sum +=
        weight * reflectance * sampled_light(rays_, lights_, at, glm::vec3(numbers.next()), cast);
    if (surface == depth_) return sum;

    // Cosine-distributed: f cos / pdf is the albedo.
    weight *= kPi * reflectance;
    const glm::vec4 u = numbers.next();
    if (surface >= kFirstRoulette) {
      const float survival =
          std::min(kGreatestSurvival, std::max(weight.x, std::max(weight.y, weight.z)));
      if (u.z >= survival) return sum;
      weight /= survival;
    }
    const glm::vec3 direction = glm::normalize(
        ray_tracing::frame_around(at.normal).to_world(ray_tracing::cosine_hemisphere({u.x, u.y})));
    if (glm::dot(direction, at.geometric_normal) <= 0.0F) return sum;
    ++cast;
    ray_tracing::Hit hit;
    if (!rays_.intersect(ray_from(at.surface, direction), hit)) return sum;
    at = indirect_view::viewed_point(hit, -direction, point.seed, point.index);
  }
}

}  // namespace renderers::irradiance_cache
