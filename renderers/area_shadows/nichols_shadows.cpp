#include "renderers/area_shadows/nichols_shadows.h"

#include <optional>
#include <utility>

#include "renderers/area_shadows/fragment_pictures.h"
#include "renderers/area_shadows/fragment_upsampling.h"
#include "renderers/area_shadows/multires_settings.h"
#include "renderers/area_shadows/neighbour_refinement.h"
#include "renderers/area_shadows/screen_shadows_renderer.h"

namespace renderers::area_shadows {

namespace {

/// Parameters, typed.
struct NicholsSettings {
  DiscontinuitySettings discontinuities;
  NeighbourSettings refinement;
  bool upsamples_visibility = true;
  bool has_passes = true;
};

FragmentLight light_middles(ShadowTracer& tracer, const FragmentSet& set) {
  FragmentLightSettings settings;
  settings.estimate = IrradianceEstimate::pixel;
  settings.has_extra_samples = false;
  return light_fragments(tracer, set, settings);
}

PixelIrradiance upsample(const FragmentSet& set, const FragmentLight& light,
                         const NicholsSettings& settings, StageTimer::Stage& stage) {
  if (!settings.has_passes) return upsample_nearest(set, light);
  MultiPass passes = upsample_multi_pass(set, light, settings.refinement.coarsest_level);
  stage.add_bytes(passes.bytes);
  return std::move(passes.irradiance);
}

ShadowResult solve(const ShadowJob& job, const NicholsSettings& settings, StageTimer& timer) {
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
    set = refine_by_neighbours(*tracer, *discontinuities, settings.refinement);
    stage.add_bytes(tracer->memory_bytes() + tracer->list_bytes());
  }
  {
    const auto stage = timer.stage("gather");
    const auto inner = timer.stage("irradiance");
    light = light_middles(*tracer, set);
  }
  ShadowResult result;
  {
    auto stage = timer.stage("upsample");
    FragmentLight values = light;
    if (settings.upsamples_visibility) take_visible_share(values);
    result.irradiance = upsample(set, values, settings, stage);
    if (settings.upsamples_visibility) {
      restore_irradiance(*tracer, set, light, result.irradiance);
    }
  }
  result.rays = static_cast<double>(set.rays + light.gather_rays);
  const auto stage = timer.stage("readback");
  result.aovs = fragment_pictures(set, light, *tracer);
  result.counters = fragment_counters(set, light, *tracer);
  return result;
}

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs{
      backend_parameter(),
      base::integer_parameter("coarsest_level", 5, {0.0, 8.0}, "",
                              "Fragments begin with 2^coarsest_level pixels; ours."),
      base::integer_parameter("light_points", 64, {4.0, 256.0}, "points",
                              "Points of each light, tested at every fragment and its neighbours, "
                              "a power of two; the paper's comparison has 64."),
      base::integer_parameter(
          "bit_threshold", 4, {0.0, 256.0}, "bits",
          "So many bits that differ from a neighbour's split a fragment; ours."),
      base::choice_parameter("upsampling", {"multi_pass", "nearest"}, "multi_pass",
                             "multi_pass: level by level; nearest: each pixel its fragment's."),
      base::choice_parameter("upsampled", {"visibility", "irradiance"}, "visibility",
                             "irradiance, as in the papers; visibility: its share of the "
                             "unoccluded one, which each pixel finds for itself; ours.")};
  for (base::ParameterSpec& spec : discontinuity_parameters()) specs.push_back(std::move(spec));
  return specs;
}

std::vector<base::Preset> presets() {
  using Value = base::ParameterValue;
  base::Preset paper{"paper",
                     {{"bit_threshold", Value(std::int64_t{1})},
                      {"upsampled", Value(std::string("irradiance"))},
                      {"depth_measure", Value(std::string("range"))},
                      {"depth_threshold", Value(0.1)},
                      {"normal_measure", Value(std::string("range"))},
                      {"normal_threshold", Value(0.2)}}};
  return {std::move(paper), base::Preset{"best", {}}};
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  const std::int64_t points = parameters.integer("light_points");
  check_power_of_two("nichols-shadows", "light_points", points);
  NicholsSettings settings;
  settings.discontinuities = discontinuity_settings(parameters);
  settings.refinement.coarsest_level = static_cast<int>(parameters.integer("coarsest_level"));
  settings.refinement.bit_threshold = static_cast<int>(parameters.integer("bit_threshold"));
  settings.upsamples_visibility = parameters.text("upsampled") == "visibility";
  settings.has_passes = parameters.text("upsampling") == "multi_pass";
  return make_screen_shadows_renderer(
      {static_cast<int>(points), ray_tracing::kGroupPoints, backend_of(parameters)},
      [settings](const ShadowJob& job, StageTimer& timer) { return solve(job, settings, timer); },
      devices);
}

}  // namespace

RendererInfo nichols_shadows_info() {
  RendererInfo info = screen_shadows_info();
  info.name = "nichols-shadows";
  info.summary =
      "Direct light of area lights at fragments of the picture, refined where neighbouring "
      "fragments see other parts of the lights.";
  info.source =
      "Nichols, Penmatsa, Wyman 2010, doi:10.1111/j.1467-8659.2010.01723.x, as Koa and Johan 2016 "
      "describe it";
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::area_shadows
