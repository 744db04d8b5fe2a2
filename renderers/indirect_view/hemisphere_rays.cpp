#include "renderers/indirect_view/hemisphere_rays.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::indirect_view {

namespace {

using ray_tracing::SampleSequence;
using ray_tracing::SequenceKind;

/// Keys that keep the numbers of directions apart from those of the surfaces they meet.
constexpr std::uint64_t kDirectionKey = 11;
constexpr std::uint64_t kSurfaceKey = 12;

}  // namespace

glm::vec2 hemisphere_sample(const HemisphereRays& settings, const ViewedPoint& point, int ray) {
  const auto count = static_cast<std::uint64_t>(settings.rays);
  const std::uint64_t index = point.index * count + static_cast<std::uint64_t>(ray);
  const std::uint64_t seed = ray_tracing::hash_combine(point.seed, kDirectionKey);
  const bool is_sobol = settings.sequence == HemisphereSequence::sobol;
  SampleSequence numbers(is_sobol ? SequenceKind::sobol : SequenceKind::random, seed, index);
  const glm::vec2 u(numbers.next());
  const int rows = static_cast<int>(std::sqrt(static_cast<float>(settings.rays)));
  const int columns = settings.rays / rows;
  // What does not fill a row of the grid is spread over the whole square.
  if (settings.sequence != HemisphereSequence::strata || ray >= rows * columns) return u;
  return {ray_tracing::in_stratum(ray / columns, u.x, rows),
          ray_tracing::in_stratum(ray % columns, u.y, columns)};
}

glm::vec3 gather_irradiance(const ray_tracing::RayScene& rays, const ViewedPoint& point,
                            const HemisphereRays& settings, const RayRadiance& radiance,
                            std::uint64_t& cast) {
  const ray_tracing::Frame3 frame = ray_tracing::frame_around(point.normal);
  const std::uint64_t seed =
      ray_tracing::hash_combine(ray_tracing::hash_combine(point.seed, kSurfaceKey), point.index);
  glm::vec3 sum(0.0F);
  for (int i = 0; i < settings.rays; ++i) {
    const glm::vec3 local = ray_tracing::cosine_hemisphere(hemisphere_sample(settings, point, i));
    const glm::vec3 direction = glm::normalize(frame.to_world(local));
    if (glm::dot(direction, point.geometric_normal) <= 0.0F) continue;
    ++cast;
    ray_tracing::Hit hit;
    if (!rays.intersect(ray_from(point.surface, direction), hit)) continue;
    const std::uint64_t ray_seed = ray_tracing::hash_combine(seed, static_cast<std::uint64_t>(i));
    sum += radiance(viewed_point(hit, -direction, ray_seed, 0), hit.t);
  }
  return sum * (ray_tracing::kPi / static_cast<float>(settings.rays));
}

}  // namespace renderers::indirect_view
