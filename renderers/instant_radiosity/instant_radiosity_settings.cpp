#include "renderers/instant_radiosity/instant_radiosity_settings.h"

#include <array>
#include <utility>

#include "renderers/contract/choice_names.h"

namespace renderers::instant_radiosity {

namespace {

using base::boolean_parameter;
using base::choice_parameter;
using base::integer_parameter;
using base::ParameterSpec;
using base::real_parameter;

constexpr double kMostSamples = 1 << 20;
constexpr double kMostLights = 1 << 20;
constexpr double kMostMapSide_px = 8192;

constexpr std::array kVisibilities{
    std::pair{"none", Visibility::none}, std::pair{"shadow_map", Visibility::shadow_map},
    std::pair{"ray", Visibility::ray}, std::pair{"imperfect", Visibility::imperfect}};

std::vector<ParameterSpec> visibility_parameters() {
  return {
      choice_parameter("visibility", names_of(kVisibilities), "ray",
                       "Between receiver and virtual light. none: all is seen; shadow_map: a map "
                       "per light; imperfect: a map of points per light (Ritschel et al. 2008); "
                       "ray: one ray each, the truth for the lights at hand."),
      integer_parameter("shadow_map_px", 128, {8.0, kMostMapSide_px}, "pixels",
                        "Side of a virtual light's map; ours."),
      integer_parameter("shadow_map_batch", 64, {1.0, 2048.0}, "maps",
                        "Maps that exist at a time: memory against passes; ours."),
      integer_parameter("imperfect_points", 1024, {16.0, 65536.0}, "points",
                        "Points splatted into each imperfect map; ours."),
      boolean_parameter("imperfect_points_kept", false,
                        "In a sequence, points are dealt to triangles at its first frame and move "
                        "with them (Ritschel et al. 2008 make them ahead); where an object's list "
                        "of triangles changes they stay behind. Else every frame deals anew."),
      boolean_parameter("fill_holes", true,
                        "Pull-push over the imperfect maps (Ritschel et al. 2008)."),
      integer_parameter("compensation_rays", 0, {0.0, 4096.0}, "rays per pixel",
                        "Short rays that bring back what the bound takes away (Kollig and Keller "
                        "2004); 0: none, the loss stays."),
  };
}

}  // namespace

std::vector<ParameterSpec> parameter_specs() {
  std::vector<ParameterSpec> specs{
      integer_parameter("samples", 1, {1.0, kMostSamples}, "light sets",
                        "Sets of virtual lights, each through other points of the pixels; 1: one "
                        "set through the pixel centres."),
  };
  for (auto group : {many_lights::picture_parameters(kMostLights), visibility_parameters()}) {
    specs.insert(specs.end(), std::make_move_iterator(group.begin()),
                 std::make_move_iterator(group.end()));
  }
  return specs;
}

std::vector<base::Preset> presets() {
  using Value = base::ParameterValue;
  // Keller 1997: every virtual light shades every pixel through its own shadow map, unbounded.
  base::Preset paper{"paper",
                     {{"visibility", Value(std::string("shadow_map"))},
                      {"light_sampling", Value(std::string("map"))},
                      {"interleave", Value(std::int64_t{1})},
                      {"blur", Value(std::string("none"))},
                      {"clamp_radius", Value(0.0)}}};
  base::Preset best{"best", {{"compensation_rays", Value(std::int64_t{8})}}};
  return {std::move(paper), std::move(best)};
}

Settings settings_of(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  Settings settings{many_lights::picture_settings_of(parameters)};
  settings.samples = parameters.integer("samples");
  settings.visibility = value_of(kVisibilities, parameters.text("visibility"));
  settings.shadow_map_px = integer("shadow_map_px");
  settings.shadow_map_batch = integer("shadow_map_batch");
  settings.imperfect_points = integer("imperfect_points");
  settings.keeps_imperfect_points = parameters.boolean("imperfect_points_kept");
  settings.fills_holes = parameters.boolean("fill_holes");
  settings.compensation_rays = integer("compensation_rays");
  return settings;
}

Claims claims_of(const base::Parameters& parameters, const scene::Scene& scene) {
  const Settings settings = settings_of(parameters);
  Claims claims;
  claims.transport = Transport::one_bounce;
  claims.part = settings.part;
  const double clamp = many_lights::geometry_clamp_of(settings, scene);
  if (clamp > 0.0 && settings.compensation_rays == 0) claims.geometry_clamp = clamp;
  return claims;
}

}  // namespace renderers::instant_radiosity
