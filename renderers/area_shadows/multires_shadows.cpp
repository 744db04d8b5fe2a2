#include "renderers/area_shadows/multires_shadows.h"

#include <algorithm>
#include <optional>

#include "renderers/area_shadows/fragment_pictures.h"
#include "renderers/area_shadows/multires_settings.h"
#include "renderers/area_shadows/screen_shadows_renderer.h"
#include "renderers/area_shadows/shadow_audit.h"

namespace renderers::area_shadows {

namespace {

struct Upsampled {
  PixelIrradiance pixels;
  std::int64_t bytes = 0;  ///< of what lies between fragments and pixels: samples, levels
};

Upsampled upsample(const ShadowJob& job, const FragmentSet& set, const FragmentLight& light,
                   const MultiresSettings& settings) {
  const auto bytes_of = [](const std::vector<LightSample>& samples) {
    return static_cast<std::int64_t>(samples.size() * sizeof(LightSample));
  };
  const std::int64_t centres = bytes_of(light.centres);
  switch (settings.upsampling) {
    case Upsampling::nearest:
      return {upsample_nearest(set, light), centres};
    case Upsampling::multi_pass: {
      MultiPass passes = upsample_multi_pass(set, light, settings.refinement.coarsest_level);
      return {std::move(passes.irradiance), centres + passes.bytes};
    }
    case Upsampling::rbf:
      break;
  }
  const std::int64_t bytes = centres + bytes_of(light.extras);
  return {upsample_by_rbf(job.surfaces, set, light, settings.rbf), bytes};
}

/// How the pixels got their values.
std::vector<RbfPlace> places_of(const ShadowJob& job, const FragmentSet& set,
                                const FragmentLight& light, const MultiresSettings& settings) {
  if (settings.upsampling != Upsampling::rbf) {
    return std::vector<RbfPlace>(set.at.size(), RbfPlace::copied);
  }
  return rbf_places(job.surfaces, set, light, settings.rbf);
}

void audit(const ShadowJob& job, const FragmentSet& set, const FragmentLight& light,
           const MultiresSettings& settings, ShadowTracer& tracer, ShadowResult& result) {
  const std::vector<RbfPlace> places = places_of(job, set, light, settings);
  auto counters =
      audit_counters(tracer, {set, result.irradiance, places, settings.refinement.coarsest_level});
  result.counters.insert(result.counters.end(), counters.begin(), counters.end());
}

ShadowResult solve(const ShadowJob& job, const MultiresSettings& settings, StageTimer& timer) {
  std::optional<DiscontinuityPyramid> discontinuities;
  std::optional<ShadowTracer> tracer;
  FragmentSet set;
  FragmentLight light;
  {
    const auto stage = timer.stage("build");
    const auto inner = timer.stage("discontinuities");
    discontinuities.emplace(job.surfaces, settings.discontinuities,
                            settings.refinement.coarsest_level + 1);
  }
  {
    auto stage = timer.stage("visibility");
    tracer.emplace(job.visibility, job.surfaces, job.lights, timer);
    set = refine_fragments(*tracer, *discontinuities, settings.refinement);
    stage.add_bytes(tracer->memory_bytes() + tracer->list_bytes());
  }
  {
    const auto stage = timer.stage("gather");
    const auto inner = timer.stage("irradiance");
    if (!settings.reuses_bits) tracer.emplace(job.visibility, job.surfaces, job.lights, timer);
    light = light_fragments(*tracer, set, settings.light);
  }
  ShadowResult result;
  std::optional<FragmentLight> shares;  // of the light, if those are upsampled
  Upsampled upsampled;
  {
    auto stage = timer.stage("upsample");
    if (settings.upsamples_visibility) {
      shares = light;
      take_visible_share(*shares);
    }
    upsampled = upsample(job, set, shares ? *shares : light, settings);
    stage.add_bytes(upsampled.bytes);
    result.irradiance = std::move(upsampled.pixels);
    if (settings.upsamples_visibility) {
      const auto inner = timer.stage("unoccluded");
      restore_irradiance(*tracer, set, light, result.irradiance);
    }
  }
  result.rays = static_cast<double>(set.rays + light.gather_rays + light.extra_rays);
  const auto stage = timer.stage("readback");
  result.aovs = fragment_pictures(set, light, *tracer);
  result.counters = fragment_counters(set, light, *tracer);
  result.counters.emplace_back("upsampling_bytes", static_cast<double>(upsampled.bytes));
  if (settings.has_audit) audit(job, set, shares ? *shares : light, settings, *tracer, result);
  return result;
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  const MultiresSettings settings = multires_settings(parameters);
  const ScreenShadowsSettings shared{
      4 * settings.rays_per_quadrant,
      std::min(ray_tracing::kGroupPoints, static_cast<std::size_t>(settings.rays_per_quadrant)),
      backend_of(parameters)};
  return make_screen_shadows_renderer(
      shared,
      [settings](const ShadowJob& job, StageTimer& timer) { return solve(job, settings, timer); },
      devices);
}

}  // namespace

RendererInfo multires_shadows_info() {
  RendererInfo info = screen_shadows_info();
  info.name = "multires-shadows";
  info.summary =
      "Direct light of area lights at fragments of the picture that are as fine as shadows and "
      "surfaces need, interpolated between them.";
  info.source = "Koa and Johan 2016, doi:10.1145/2949035.2949043";
  info.parameters = multires_parameters();
  info.presets = multires_presets();
  info.create = create;
  return info;
}

}  // namespace renderers::area_shadows
