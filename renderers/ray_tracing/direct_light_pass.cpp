#include "renderers/ray_tracing/direct_light_pass.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/ray_tracing/point_light_shading.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_tracing {

namespace {

constexpr int kTileSide_px = 16;

int tiles_along(int side_px) { return (side_px + kTileSide_px - 1) / kTileSide_px; }

void check_count(const char* name, int count) {
  if (count >= 1) return;
  throw base::InputError(std::string("direct light pass: ") + name + " is " +
                         std::to_string(count) + "; accepted: 1 and more");
}

void store(perception::Image& image, int x, int y, const glm::vec3& color) {
  std::copy_n(&color.x, 3, image.pixel(x, y).begin());
}

/// Rays of all threads.
struct SharedCounts {
  std::atomic<std::uint64_t> camera = 0;
  std::atomic<std::uint64_t> shadow = 0;
  std::atomic<std::uint64_t> reflected = 0;

  void add(const DirectLightCounts& counts) {
    camera.fetch_add(counts.camera, std::memory_order_relaxed);
    shadow.fetch_add(counts.shadow, std::memory_order_relaxed);
    reflected.fetch_add(counts.reflected, std::memory_order_relaxed);
  }
};

}  // namespace

/// A pixel's place and its sequences of random numbers.
struct DirectLightPass::Pixel {
  int x = 0;
  int y = 0;
  std::uint64_t camera_seed = 0;
  std::uint64_t light_seed = 0;
  std::uint32_t pass = 0;
};

struct DirectLightPass::Estimate {
  glm::vec3 lit{0.0F};
  glm::vec3 seen{0.0F};
};

DirectLightPass::DirectLightPass(const RayScene& rays, const DirectLightSettings& settings)
    : rays_(rays), settings_(settings), areas_(rays, LightSet::hittable) {
  check_count("camera_rays", settings.camera_rays);
  check_count("light_samples", settings.light_samples);
}

DirectLight DirectLightPass::render(const DirectLightJob& job) const {
  DirectLight result;
  result.radiance =
      perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  result.seen = result.radiance;
  const CameraRays camera(job.camera, job.width_px, job.height_px);
  const int columns = tiles_along(job.width_px);
  const auto tiles =
      static_cast<std::size_t>(columns) * static_cast<std::size_t>(tiles_along(job.height_px));
  SharedCounts shared;

  const auto render_tile = [&](int tile) {
    const int x_begin = tile % columns * kTileSide_px;
    const int y_begin = tile / columns * kTileSide_px;
    DirectLightCounts counts;
    for (int y = y_begin; y < std::min(job.height_px, y_begin + kTileSide_px); ++y) {
      for (int x = x_begin; x < std::min(job.width_px, x_begin + kTileSide_px); ++x) {
        const std::uint64_t seed = hash_combine(job.seed, result.radiance.offset(x, y) / 3);
        const Pixel pixel{x, y, hash_combine(seed, 0), hash_combine(seed, 1), job.pass};
        const Estimate estimate = estimate_pixel(camera, pixel, counts);
        store(result.seen, x, y, estimate.seen);
        store(result.radiance, x, y, estimate.lit + estimate.seen);
      }
    }
    shared.add(counts);
  };
  base::parallel_for(tiles, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t tile = begin; tile < end; ++tile) render_tile(static_cast<int>(tile));
  });
  result.counts = {shared.camera, shared.shadow, shared.reflected};
  return result;
}

DirectLightPass::Estimate DirectLightPass::estimate_pixel(const CameraRays& camera,
                                                          const Pixel& pixel,
                                                          DirectLightCounts& counts) const {
  Estimate sum;
  const auto count = static_cast<std::uint32_t>(settings_.camera_rays);
  for (std::uint32_t i = pixel.pass * count; i < (pixel.pass + 1) * count; ++i) {
    glm::vec2 position = glm::vec2(0.5F) + settings_.offset_px;
    if (settings_.pixel_rays == PixelRays::spread) {
      position = glm::vec2(SampleSequence(SequenceKind::sobol, pixel.camera_seed, i).next());
    }
    const Ray ray = camera.through(static_cast<float>(pixel.x) + position.x,
                                   static_cast<float>(pixel.y) + position.y);
    counts.camera += 1;
    Hit hit;
    if (!rays_.intersect(ray, hit)) {
      sum.seen += areas_.environment(ray.direction);
      continue;
    }
    sum.seen += areas_.emission(hit, -ray.direction);
    const SurfaceBrdf brdf = make_brdf(rays_.scene(), hit, -ray.direction, Lobes::all);
    if (is_black(brdf)) continue;
    sum.lit += reflected_point_lights(rays_, areas_, hit, brdf, counts.shadow) +
               light_of_areas(hit, brdf, pixel, i, counts);
  }
  const float weight = 1.0F / static_cast<float>(count);
  return {weight * sum.lit, weight * sum.seen};
}

glm::vec3 DirectLightPass::light_of_areas(const SurfacePoint& point, const SurfaceBrdf& brdf,
                                          const Pixel& pixel, std::uint32_t camera_ray,
                                          DirectLightCounts& counts) const {
  if (areas_.is_empty()) return glm::vec3(0.0F);
  const auto count = static_cast<std::uint32_t>(settings_.light_samples);
  glm::vec3 sum(0.0F);
  for (std::uint32_t i = camera_ray * count; i < (camera_ray + 1) * count; ++i) {
    SampleSequence numbers(SequenceKind::sobol, pixel.light_seed, i);
    const glm::vec4 light_u = numbers.next();
    sum += sample_light(point, brdf, glm::vec3(light_u), counts);
    if (!has_reflected_rays(brdf)) continue;
    sum += follow_reflection(point, brdf, glm::vec3(numbers.next()), counts);
  }
  return sum / static_cast<float>(count);
}

bool DirectLightPass::has_reflected_rays(const SurfaceBrdf& brdf) const {
  return settings_.reflected_rays == ReflectedRays::always || brdf.glossy_share > 0.0F;
}

glm::vec3 DirectLightPass::sample_light(const SurfacePoint& point, const SurfaceBrdf& brdf,
                                        const glm::vec3& u, DirectLightCounts& counts) const {
  const std::optional<LightSample> light = areas_.sample(point, u);
  if (!light) return glm::vec3(0.0F);
  const glm::vec3 reflected = evaluate(brdf, light->direction) * light->radiance;
  if (reflected == glm::vec3(0.0F)) return glm::vec3(0.0F);
  counts.shadow += 1;
  if (rays_.is_occluded(light->shadow_ray)) return glm::vec3(0.0F);
  float weight = 1.0F;
  if (has_reflected_rays(brdf)) weight = power_heuristic(light->pdf, pdf(brdf, light->direction));
  return reflected * (weight / light->pdf);
}

glm::vec3 DirectLightPass::follow_reflection(const SurfacePoint& point, const SurfaceBrdf& brdf,
                                             const glm::vec3& u, DirectLightCounts& counts) const {
  const BrdfSample drawn = sample(brdf, u.z, {u.x, u.y});
  if (drawn.value == glm::vec3(0.0F)) return glm::vec3(0.0F);
  counts.reflected += 1;
  glm::vec3 radiance(0.0F);
  float light_pdf = 0.0F;
  Hit hit;
  if (rays_.intersect(ray_from(point, drawn.direction), hit)) {
    radiance = areas_.emission(hit, -drawn.direction);
    if (radiance == glm::vec3(0.0F)) return glm::vec3(0.0F);
    light_pdf = areas_.pdf_of_emission(hit, drawn.direction, hit.t);
  } else {
    radiance = areas_.environment(drawn.direction);
    light_pdf = areas_.pdf_of_environment(drawn.direction);
  }
  return drawn.value * radiance * (power_heuristic(drawn.pdf, light_pdf) / drawn.pdf);
}

}  // namespace renderers::ray_tracing
