#include "renderers/light_propagation/sample_light.h"

#include <atomic>
#include <cmath>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/light_propagation/intensity_lobe.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::light_propagation {

namespace {

constexpr std::size_t kSampleGrain = 64;
/// Of the points on the lights: the volume is the same for every picture of a scene.
constexpr std::uint64_t kPointSeed = 1;

glm::vec3 irradiance_of_point_lights(const ray_tracing::RayScene& rays,
                                     const ray_tracing::Receiver& receiver,
                                     std::uint64_t& rays_cast) {
  glm::vec3 sum(0.0F);
  for (const scene::Light& light : rays.scene().lights) {
    const glm::vec3 to_light = light.position - receiver.position;
    const float d2 = glm::dot(to_light, to_light);
    if (d2 <= 0.0F) continue;
    const glm::vec3 direction = to_light / std::sqrt(d2);
    const float cosine = glm::dot(receiver.geometric_normal, direction);
    if (cosine <= 0.0F) continue;
    const glm::vec3 arriving = scene::intensity_towards(light, -direction) * (cosine / d2);
    if (arriving == glm::vec3(0.0F)) continue;
    ++rays_cast;
    const ray_tracing::Ray ray{receiver.origin, light.position - receiver.origin,
                               ray_tracing::kSegmentEnd};
    if (!rays.is_occluded(ray)) sum += arriving;
  }
  return sum;
}

}  // namespace

GatheredLight light_samples(const ray_tracing::RayScene& rays,
                            const std::vector<SurfaceSample>& samples, int light_points) {
  const auto lights = ray_tracing::make_light_points(rays, light_points, kPointSeed);
  GatheredLight gathered;
  gathered.samples.resize(samples.size());
  std::atomic<std::uint64_t> rays_cast = 0;
  const auto flux_to = [&](const SurfaceSample& sample, float side, std::uint64_t& own_rays) {
    const auto receiver = ray_tracing::receiver_at(
        sample.point, sample.point.position + side * sample.point.geometric_normal);
    const glm::vec3 irradiance =
        ray_tracing::irradiance_by_points(rays, lights, receiver, own_rays) +
        irradiance_of_point_lights(rays, receiver, own_rays);
    return irradiance * ray_tracing::diffuse_albedo(rays.scene(), sample.point) * sample.area_m2;
  };
  base::parallel_for(samples.size(), kSampleGrain, [&](std::size_t begin, std::size_t end) {
    std::uint64_t own_rays = 0;
    for (std::size_t i = begin; i < end; ++i) {
      gathered.samples[i].front = flux_to(samples[i], 1.0F, own_rays);
      gathered.samples[i].back = flux_to(samples[i], -1.0F, own_rays);
    }
    rays_cast.fetch_add(own_rays, std::memory_order_relaxed);
  });
  gathered.rays = rays_cast;
  return gathered;
}

LightVolume inject(const Grid& grid, const std::vector<SurfaceSample>& samples,
                   const std::vector<ReflectedFlux>& flux) {
  LightVolume volume(grid);
  const auto add = [&](const SurfaceSample& sample, const glm::vec3& normal,
                       const glm::vec3& reflected) {
    if (reflected == glm::vec3(0.0F)) return;
    const glm::vec3 pushed = sample.point.position + 0.5F * grid.cell_m * normal;
    CellLight& cell = volume.cells[grid.index(grid.cell_at(pushed))];
    add_lobe(cell, cosine_lobe(normal), reflected / ray_tracing::kPi);
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    add(samples[i], samples[i].point.geometric_normal, flux[i].front);
    add(samples[i], -samples[i].point.geometric_normal, flux[i].back);
  }
  return volume;
}

BlockingVolume block_by(const ray_tracing::RayScene& rays, const Grid& grid) {
  BlockingVolume blocking(grid);
  // Cells around the nodes.
  const Grid around{grid.size + 1, grid.corner - 0.5F * grid.cell_m, grid.cell_m};
  const std::vector<CellSurface> surfaces = cut_surfaces(rays, around);
  for (std::size_t node = 0; node < around.cell_count(); ++node) {
    const glm::vec3 position = grid.corner + grid.cell_m * glm::vec3(around.cell(node));
    for (std::size_t k = 0; k < kNormalClasses; ++k) {
      const CellSurface& surface = surfaces[node * kNormalClasses + k];
      if (surface.area_m2 <= 0.0) continue;
      blocking.add(position, glm::vec3(surface.vector_area_m2 / surface.area_m2),
                   static_cast<float>(surface.area_m2));
    }
  }
  return blocking;
}

}  // namespace renderers::light_propagation
