#include "renderers/area_shadows/pcss_shadows.h"

#include <atomic>

#include "perception/base/parallel.h"
#include "renderers/area_shadows/screen_shadows_renderer.h"
#include "renderers/area_shadows/shadow_tracer.h"
#include "renderers/soft_shadows/percentage_closer.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kPixelGrain = 64;

using soft_shadows::MappedLight;
using soft_shadows::PcssSettings;

glm::vec3 irradiance_at(const std::vector<MappedLight>& lights,
                        const ray_tracing::Receiver& receiver, const PcssSettings& settings) {
  glm::vec3 sum(0.0F);
  for (const MappedLight& light : lights) {
    const glm::vec3 open = open_irradiance({light.points, 1}, receiver);
    if (open == glm::vec3(0.0F)) continue;
    sum += open * light.visible_share(receiver.position, receiver.geometric_normal, settings);
  }
  return sum;
}

ShadowResult solve(const ShadowJob& job, const PcssSettings& settings, StageTimer& timer) {
  ShadowResult result;
  std::vector<MappedLight> lights;
  double bytes = 0.0;
  {
    auto stage = timer.stage("shadow");
    auto inner = timer.stage("maps");
    lights = soft_shadows::map_lights(job.rays, job.lights, settings.map_px);
    for (const MappedLight& light : lights) {
      result.rays += static_cast<double>(light.map.ray_count());
      bytes += static_cast<double>(light.map.memory_bytes());
    }
    inner.add_bytes(static_cast<std::int64_t>(bytes));
  }
  const auto stage = timer.stage("gather");
  const auto inner = timer.stage("irradiance");
  result.irradiance.resize(job.surfaces.pixels.size());
  std::atomic<std::uint64_t> fragments = 0;
  base::parallel_for(
      result.irradiance.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
        std::uint64_t own_fragments = 0;
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
          const PixelSurface& surface = job.surfaces.pixels[pixel];
          if (!surface.is_surface()) continue;
          ++own_fragments;
          result.irradiance[pixel] = irradiance_at(lights, surface.receiver, settings);
        }
        fragments.fetch_add(own_fragments, std::memory_order_relaxed);
      });
  result.counters = {{"fragments", static_cast<double>(fragments)},
                     {"map_rays", result.rays},
                     {"map_bytes", bytes}};
  return result;
}

std::vector<base::ParameterSpec> parameter_specs() {
  return {
      base::integer_parameter("map_px", 1024, {16.0, 8192.0}, "texels",
                              "Along a side of each light's shadow map; ours."),
      base::integer_parameter("search_side", 6, {1.0, 64.0}, "samples",
                              "Blockers are searched for at the square of it; ours."),
      base::integer_parameter("filter_side", 8, {1.0, 64.0}, "samples",
                              "The filter takes the square of it; ours: as many samples as the "
                              "other techniques have points."),
      base::real_parameter("near_share", 0.2, {0.01, 1.0}, "",
                           "Nearest blocker that is looked for, by the receiver's height below the "
                           "light; the paper's is the map's near plane; ours."),
      base::real_parameter(
          "bias", 0.003, {0.0, 1.0}, "",
          "A blocker is nearer, and off the tangent plane, by that share of the height; ours."),
      base::boolean_parameter("receiver_plane", true,
                              "What lies behind the receiver's tangent plane hides nothing; ours."),
      base::integer_parameter("light_points", 64, {4.0, 256.0}, "points",
                              "Of each light, for its unoccluded irradiance and its width; a power "
                              "of two; as the others.")};
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  const auto real = [&](const char* name) { return static_cast<float>(parameters.real(name)); };
  check_power_of_two("pcss", "light_points", parameters.integer("light_points"));
  const PcssSettings settings{integer("map_px"),      integer("search_side"),
                              integer("filter_side"), real("near_share"),
                              real("bias"),           parameters.boolean("receiver_plane")};
  return make_screen_shadows_renderer(
      {integer("light_points"), ray_tracing::kGroupPoints},
      [settings](const ShadowJob& job, StageTimer& timer) { return solve(job, settings, timer); },
      devices);
}

}  // namespace

RendererInfo pcss_shadows_info() {
  RendererInfo info = screen_shadows_info();
  std::erase(info.supports, Feature::environment);
  info.name = "pcss";
  info.summary =
      "Direct light of area lights by percentage-closer soft shadows in a shadow map from each "
      "light's centre.";
  info.source = "Fernando 2005, doi:10.1145/1187112.1187153";
  info.parameters = parameter_specs();
  info.presets = {{"paper", {{"receiver_plane", base::ParameterValue(false)}}}, {"best", {}}};
  info.create = create;
  return info;
}

}  // namespace renderers::area_shadows
