#include "renderers/irradiance_cache/cached_light.h"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::irradiance_cache {

namespace {

using indirect_view::ViewedPoint;
using ray_tracing::hash_combine;

/// Pixels from one to the next on the coarsest grid, and those of a group; ours.
constexpr int kFirstStride_px = 16;
constexpr std::size_t kGroup = 32;
/// Reach of records in the picture over that in `fill`: points between pixels' centres find those
/// of their neighbours. Ours.
constexpr float kStretch = 1.5F;

/// Pixels that are new on a grid, in an order that scatters neighbours.
std::vector<std::size_t> pixels_of_stride(const RenderJob& job, int stride_px) {
  std::vector<std::size_t> pixels;
  for (int y = 0; y < job.height_px; y += stride_px) {
    for (int x = 0; x < job.width_px; x += stride_px) {
      const bool is_old =
          stride_px < kFirstStride_px && x % (2 * stride_px) == 0 && y % (2 * stride_px) == 0;
      if (is_old) continue;
      pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(job.width_px) +
                       static_cast<std::size_t>(x));
    }
  }
  std::ranges::sort(pixels, {}, [](std::size_t pixel) { return hash_combine(1, pixel); });
  return pixels;
}

}  // namespace

CachedLight::CachedLight(const ray_tracing::RayScene& rays, const CacheSettings& settings)
    : rays_(rays),
      settings_(settings),
      bounces_(rays, settings.depth),
      records_(settings.records, rays.box_min(), rays.box_max()) {}

IrradianceRecord CachedLight::record_at(const ViewedPoint& point, std::uint64_t& cast) const {
  return sample_record(
      rays_, point, settings_.grid, settings_.spacing,
      [&](const ViewedPoint& seen, float) { return bounces_.reflected(seen, cast); }, cast);
}

void CachedLight::fill(const RenderJob& job, std::uint64_t seed) {
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const auto width = static_cast<std::size_t>(job.width_px);
  struct Made {
    std::optional<IrradianceRecord> record;
    std::uint64_t cast = 0;
  };
  const auto make = [&](std::size_t pixel) {
    Made made;
    const ray_tracing::Ray ray = camera.through(static_cast<float>(pixel % width) + 0.5F,
                                                static_cast<float>(pixel / width) + 0.5F);
    ray_tracing::Hit hit;
    if (!rays_.intersect(ray, hit)) return made;
    if (ray_tracing::diffuse_albedo(rays_.scene(), hit) == glm::vec3(0.0F)) return made;
    const ViewedPoint point =
        indirect_view::viewed_point(hit, -ray.direction, hash_combine(seed, pixel), 0);
    if (!records_.irradiance(hit.position, point.normal)) {
      made.record = record_at(point, made.cast);
    }
    return made;
  };
  for (int stride_px = kFirstStride_px; stride_px >= 1; stride_px /= 2) {
    const std::vector<std::size_t> pixels = pixels_of_stride(job, stride_px);
    for (std::size_t first = 0; first < pixels.size(); first += kGroup) {
      const auto group = std::span(pixels).subspan(first, std::min(kGroup, pixels.size() - first));
      std::vector<Made> made(group.size());
      base::parallel_for(group.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) made[i] = make(group[i]);
      });
      for (const Made& one : made) {
        record_rays_ += one.cast;
        if (!one.record) continue;
        if (records_.irradiance(one.record->position, one.record->normal)) {
          ++discarded_;
        } else {
          records_.insert(*one.record);
        }
      }
    }
  }
}

glm::vec3 CachedLight::irradiance(const ViewedPoint& point, std::uint64_t& rays) const {
  const auto known = records_.irradiance(point.surface.position, point.normal, kStretch);
  if (known) return *known;
  uncovered_.fetch_add(1, std::memory_order_relaxed);
  return record_at(point, rays).irradiance;
}

glm::vec3 CachedLight::reflected(const ViewedPoint& point, std::uint64_t& rays) const {
  return bounces_.reflected(point, rays);
}

}  // namespace renderers::irradiance_cache
