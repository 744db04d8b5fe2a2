#include "renderers/ray_bundles/soft_direct_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/devices.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/point_light_shading.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_bundles {

namespace {

constexpr std::size_t kPixelGrain = 64;
constexpr std::uint64_t kPointSeed = 1;  ///< the points are the same for every picture

using ray_tracing::SurfaceBrdf;
using ray_tracing::SurfacePoint;

/// Reflected radiance of a lamp's points that nothing hides.
glm::vec3 reflected_open(const ray_tracing::LightPointSet& light, const SurfacePoint& point,
                         const SurfaceBrdf& brdf) {
  glm::vec3 sum(0.0F);
  for (const ray_tracing::LightPoint& source : light.points) {
    const glm::vec3 step = source.position - point.position;
    const float square_m2 = glm::dot(step, step);
    if (square_m2 <= 0.0F) continue;
    const glm::vec3 direction = step / std::sqrt(square_m2);
    const float leaving = -glm::dot(source.normal, direction);
    if (leaving <= 0.0F) continue;
    sum += evaluate(brdf, direction) * source.power * (leaving / square_m2);
  }
  return sum;
}

struct PixelLight {
  glm::vec3 seen{0.0F};
  glm::vec3 lit{0.0F};
};

}  // namespace

SoftDirectLight::SoftDirectLight(const ray_tracing::RayScene& rays,
                                 const SoftLightSettings& settings)
    : settings_(settings) {
  if (rays.scene().environment) {
    throw UnsupportedError(
        "ray-bundles: direct pcss has no shadow map of an environment; take next_event or bundles");
  }
  points_ = make_light_points(rays, settings.light_points, kPointSeed);
  lights_ = soft_shadows::map_lights(rays, points_, settings.shadows.map_px);
  for (const soft_shadows::MappedLight& light : lights_) {
    map_rays_ += light.map.ray_count();
    memory_bytes_ += static_cast<std::int64_t>(light.map.memory_bytes());
  }
}

glm::vec3 SoftDirectLight::reflected(const SurfacePoint& point, const SurfaceBrdf& brdf) const {
  glm::vec3 sum(0.0F);
  for (const soft_shadows::MappedLight& light : lights_) {
    const glm::vec3 open = reflected_open(*light.points, point, brdf);
    if (open == glm::vec3(0.0F)) continue;
    sum += open * light.visible_share(point.position, brdf.geometric_normal, settings_.shadows);
  }
  return sum;
}

ray_tracing::DirectLight render_soft_direct(const ray_tracing::RayScene& rays,
                                            const SoftDirectLight& soft,
                                            const ray_tracing::DirectLightJob& job,
                                            int camera_rays) {
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const ray_tracing::LightSampler lights(rays);
  const auto count = static_cast<std::uint32_t>(camera_rays);
  ray_tracing::DirectLight result;
  result.radiance =
      perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  result.seen = result.radiance;
  const auto light_along = [&](const ray_tracing::Ray& ray, std::uint64_t& shadow_rays) {
    PixelLight light;
    ray_tracing::Hit hit;
    if (!rays.intersect(ray, hit)) return light;
    light.seen = lights.emission(hit, -ray.direction);
    const SurfaceBrdf brdf = make_brdf(rays.scene(), hit, -ray.direction, ray_tracing::Lobes::all);
    if (is_black(brdf)) return light;
    light.lit =
        reflected_point_lights(rays, lights, hit, brdf, shadow_rays) + soft.reflected(hit, brdf);
    return light;
  };
  const auto render_pixel = [&](std::size_t pixel, std::uint64_t& shadow_rays) {
    const auto width = static_cast<std::size_t>(job.width_px);
    const std::uint64_t seed = ray_tracing::hash_combine(job.seed, pixel);
    PixelLight sum;
    for (std::uint32_t i = job.pass * count; i < (job.pass + 1) * count; ++i) {
      const glm::vec4 u =
          ray_tracing::SampleSequence(ray_tracing::SequenceKind::sobol, seed, i).next();
      const PixelLight light = light_along(camera.through(static_cast<float>(pixel % width) + u.x,
                                                          static_cast<float>(pixel / width) + u.y),
                                           shadow_rays);
      sum.seen += light.seen;
      sum.lit += light.lit;
    }
    const float weight = 1.0F / static_cast<float>(count);
    const auto at = static_cast<std::ptrdiff_t>(3 * pixel);
    const glm::vec3 seen = weight * sum.seen;
    const glm::vec3 all = seen + weight * sum.lit;
    std::copy_n(&seen.x, 3, result.seen.pixels.begin() + at);
    std::copy_n(&all.x, 3, result.radiance.pixels.begin() + at);
  };
  const std::size_t pixels = result.radiance.pixel_count();
  std::atomic<std::uint64_t> shadow_rays = 0;
  base::parallel_for(pixels, kPixelGrain, [&](std::size_t begin, std::size_t end) {
    std::uint64_t own_rays = 0;
    for (std::size_t pixel = begin; pixel < end; ++pixel) render_pixel(pixel, own_rays);
    shadow_rays.fetch_add(own_rays, std::memory_order_relaxed);
  });
  result.counts = {pixels * count, shadow_rays, 0};
  return result;
}

}  // namespace renderers::ray_bundles
