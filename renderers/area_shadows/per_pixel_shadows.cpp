#include "renderers/area_shadows/per_pixel_shadows.h"

#include "perception/base/parallel.h"
#include "renderers/area_shadows/screen_shadows_renderer.h"
#include "renderers/area_shadows/shadow_picture.h"
#include "renderers/area_shadows/shadow_tracer.h"
#include "renderers/ray_tracing/light_points.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kPixelGrain = 64;
/// Less of the light than that is none.
constexpr float kLeastShare = 0.02F;

/// To the bit what `ray_tracing::irradiance_by_points` gives.
glm::vec3 irradiance_of(const ShadowJob& job, const PixelPoints& points) {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < points.groups.size(); ++i) {
    if (points.visible[i] == 0) continue;
    const GroupRays& at = points.groups[i];
    const ray_tracing::LightPointSet& light = job.lights[at.light];
    sum += group_irradiance(light, at.group, points.factors[i], points.visible[i]);
  }
  return sum;
}

/// Irradiance, rays and counters.
void light_pixels(const ShadowJob& job, ShadowResult& result, StageTimer& timer) {
  result.irradiance.resize(job.surfaces.pixels.size());
  const std::vector<std::uint32_t> pixels = surface_pixels(job.surfaces);
  const RayCounts counts = visit_pixels(
      job.visibility, {job.surfaces, job.lights, pixels}, timer, [&](const PixelPoints& points) {
        result.irradiance[points.pixel] = irradiance_of(job, points);
      });
  result.rays = static_cast<double>(counts.rays);
  result.counters = {{"fragments", static_cast<double>(pixels.size())},
                     {"unhidden_rays", static_cast<double>(counts.unhidden)}};
}

/// 1 at pixels that see some of the light but not all, else 0.
perception::Image penumbra_image(const ShadowJob& job, const std::vector<glm::vec3>& irradiance) {
  perception::Image image = perception::make_gray_image(
      job.surfaces.width_px, job.surfaces.height_px, "Y", perception::Encoding::scene_linear);
  base::parallel_for(irradiance.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      const PixelSurface& surface = job.surfaces.pixels[pixel];
      if (!surface.is_surface()) continue;
      const glm::vec3 open = open_irradiance(job.lights, surface.receiver);
      const float all = open.x + open.y + open.z;
      const float seen = irradiance[pixel].x + irradiance[pixel].y + irradiance[pixel].z;
      const bool is_part = seen > kLeastShare * all && seen < (1.0F - kLeastShare) * all;
      image.pixels[pixel] = is_part ? 1.0F : 0.0F;
    }
  });
  return image;
}

ShadowResult solve(const ShadowJob& job, StageTimer& timer) {
  ShadowResult result;
  {
    const auto stage = timer.stage("gather");
    const auto inner = timer.stage("irradiance");
    light_pixels(job, result, timer);
  }
  const auto stage = timer.stage("readback");
  result.aovs.push_back({"penumbra", penumbra_image(job, result.irradiance)});
  return result;
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  const std::int64_t points = parameters.integer("light_points");
  check_power_of_two("per-pixel-shadows", "light_points", points);
  return make_screen_shadows_renderer(
      {static_cast<int>(points), ray_tracing::kGroupPoints, backend_of(parameters)}, solve,
      devices);
}

}  // namespace

RendererInfo per_pixel_shadows_info() {
  RendererInfo info = screen_shadows_info();
  info.name = "per-pixel-shadows";
  info.summary = "Direct light of area lights by rays to the same light points at every pixel.";
  info.source = "Koa and Johan 2016, doi:10.1145/2949035.2949043, Table 1 (c)";
  info.parameters = {backend_parameter(),
                     base::integer_parameter("light_points", 64, {4.0, 65536.0}, "points",
                                             "Points of each area light and directions of the "
                                             "environment, a power of two; the paper's "
                                             "reference has 64 samples per pixel.")};
  info.presets = {{"paper", {}}, {"best", {}}};
  info.create = create;
  return info;
}

}  // namespace renderers::area_shadows
