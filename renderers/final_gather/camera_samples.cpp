#include "renderers/final_gather/camera_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::final_gather {

namespace {

/// What a pixel's centre sees.
struct Surface {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};
  std::uint32_t object = std::numeric_limits<std::uint32_t>::max();  ///< nothing
};

/// True if two neighbours show one smooth surface: same object, normals within 18 degrees, and
/// neither far out of the other's plane for its distance along it; ours.
bool is_continuous(const Surface& a, const Surface& b) {
  constexpr float kCosine = 0.95F;
  constexpr float kSlope = 0.3F;
  if (a.object != b.object) return false;
  if (a.object == std::numeric_limits<std::uint32_t>::max()) return true;
  const glm::vec3 between = b.position - a.position;
  return glm::dot(a.normal, b.normal) > kCosine &&
         std::fabs(glm::dot(between, a.normal)) <= kSlope * glm::length(between);
}

}  // namespace

CameraSamples::CameraSamples(const ray_tracing::RayScene& rays, const RenderJob& job,
                             const CameraSampleSettings& settings)
    : width_px_(job.width_px),
      height_px_(job.height_px),
      camera_(job.camera, job.width_px, job.height_px),
      seed_(ray_tracing::hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index))) {
  const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
  counts_.assign(pixels, settings.camera_rays);
  if (settings.border_rays > settings.camera_rays) find_borders(rays, settings.border_rays);
}

void CameraSamples::find_borders(const ray_tracing::RayScene& rays, int border_rays) {
  has_borders_ = true;
  std::vector<Surface> surfaces(counts_.size());
  const auto width = static_cast<std::size_t>(width_px_);
  base::parallel_for(surfaces.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ray_tracing::Ray ray = camera_.through(static_cast<float>(i % width) + 0.5F,
                                                   static_cast<float>(i / width) + 0.5F);
      ray_tracing::Hit hit;
      if (!rays.intersect(ray, hit)) continue;
      const float side = glm::dot(hit.geometric_normal, ray.direction) < 0.0F ? 1.0F : -1.0F;
      surfaces[i] = {hit.position, side * hit.shading_normal, hit.object};
    }
  });
  for (int y = 0; y < height_px_; ++y) {
    for (int x = 0; x < width_px_; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
      const auto compare = [&](std::size_t other) {
        if (is_continuous(surfaces[at], surfaces[other])) return;
        counts_[at] = counts_[other] = border_rays;
      };
      if (x + 1 < width_px_) compare(at + 1);
      if (y + 1 < height_px_) compare(at + width);
    }
  }
}

ray_tracing::Ray CameraSamples::ray(std::size_t pixel, int index) const {
  const auto width = static_cast<std::size_t>(width_px_);
  glm::vec2 place(0.5F);
  if (counts_[pixel] > 1) {
    ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol,
                                        ray_tracing::hash_combine(seed_, pixel),
                                        static_cast<std::uint32_t>(index));
    place = glm::vec2(numbers.next());
  }
  return camera_.through(static_cast<float>(pixel % width) + place.x,
                         static_cast<float>(pixel / width) + place.y);
}

std::uint64_t CameraSamples::number(std::size_t pixel, int index) const {
  return ray_tracing::hash_combine(ray_tracing::hash_combine(seed_, pixel),
                                   static_cast<std::uint64_t>(index));
}

std::uint64_t CameraSamples::total() const {
  return std::accumulate(
      counts_.begin(), counts_.end(), std::uint64_t{0},
      [](std::uint64_t sum, int count) { return sum + static_cast<std::uint64_t>(count); });
}

std::uint64_t CameraSamples::rays_traced() const {
  return total() + (has_borders_ ? counts_.size() : 0);
}

}  // namespace renderers::final_gather
