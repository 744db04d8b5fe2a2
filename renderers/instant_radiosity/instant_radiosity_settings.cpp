#include "renderers/instant_radiosity/instant_radiosity_settings.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string_view>
#include <utility>

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
constexpr std::array kBlurs{std::pair{"none", Blur::none}, std::pair{"box", Blur::box},
                            std::pair{"separable", Blur::separable},
                            std::pair{"centred", Blur::centred}};

template <typename Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.emplace_back(entry.first);
  return names;
}

template <typename Table>
auto value_of(const Table& table, const std::string& name) {
  const auto found = std::ranges::find_if(
      table, [&](const auto& entry) { return std::string_view(entry.first) == name; });
  assert(found != table.end());
  return found->second;
}

std::vector<ParameterSpec> light_parameters() {
  return {
      integer_parameter("vpls", 1024, {1.0, kMostLights}, "virtual lights",
                        "Virtual point lights of one set; Dong et al. 2009, Sec. 6: 1024."),
      integer_parameter("light_map_px", 512, {16.0, kMostMapSide_px}, "pixels",
                        "Side of the reflective shadow map of a point or spot light, of each face "
                        "where it has several; Dachsbacher and Stamminger 2005, Sec. 5: 512 "
                        "(recalled)."),
      integer_parameter("area_light_map_px", 128, {16.0, kMostMapSide_px}, "pixels",
                        "Side of the maps of area lights and environment; ours."),
      choice_parameter("light_sampling", {"map", "solid_angle"}, "solid_angle",
                       "map: uniform on the map, weighted by cos^3 (Dachsbacher and Stamminger "
                       "2005); solid_angle: uniform in the light's cone or sphere; ours."),
      integer_parameter("area_light_maps", 16, {1.0, 1024.0}, "maps",
                        "Points on the area lights, drawn by flux, each with its own map; ours."),
      integer_parameter("environment_maps", 32, {1.0, 1024.0}, "maps",
                        "Directions of the environment, drawn by radiance, each with its own map; "
                        "ours."),
  };
}

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
      boolean_parameter("fill_holes", true,
                        "Pull-push over the imperfect maps (Ritschel et al. 2008)."),
  };
}

std::vector<ParameterSpec> gather_parameters() {
  return {
      integer_parameter("interleave", 8, {1.0, 16.0}, "pixels",
                        "Side n of the blocks whose n x n pixels share the lights; 1: every light "
                        "at every pixel; Dong et al. 2009, Sec. 6: 8."),
      real_parameter("clamp_radius", 0.03, {0.0, 1.0}, "diagonals",
                     "The geometry term is bounded by 1 / r2, r this share of the scene's "
                     "diagonal; 0: no bound; ours."),
      real_parameter("geometry_clamp", 0.0, {0.0, std::nullopt}, "1/m2",
                     "The bound itself, in place of clamp_radius; 0: clamp_radius decides."),
      integer_parameter("compensation_rays", 0, {0.0, 4096.0}, "rays per pixel",
                        "Short rays that bring back what the bound takes away (Kollig and Keller "
                        "2004); 0: none, the loss stays."),
      choice_parameter("blur", names_of(kBlurs), "centred",
                       "Over interleaved neighbours of like position and normal (Segovia et al. "
                       "2006). box: n x n, half a pixel off centre; separable: in two passes; "
                       "centred: n + 1 taps a pass with half weights at the ends."),
      real_parameter("blur_distance", 0.1, {0.0, 10.0}, "diagonals",
                     "Neighbours count within this share of the scene's diagonal; Dong et al. "
                     "2009, Sec. 6: 0.1."),
      real_parameter("blur_normal", 0.8, {-1.0, 1.0}, "",
                     "Neighbours count above this cosine between the normals; Dong et al. 2009, "
                     "Sec. 6: 0.8."),
  };
}

}  // namespace

std::vector<ParameterSpec> parameter_specs() {
  std::vector<ParameterSpec> specs{
      integer_parameter("samples", 1, {1.0, kMostSamples}, "light sets",
                        "Sets of virtual lights, each through other points of the pixels; 1: one "
                        "set through the pixel centres."),
      choice_parameter("part", {"all", "indirect"}, "all",
                       "indirect: without emission seen by the camera and direct light."),
      integer_parameter("camera_rays", 4, {1.0, 65536.0}, "rays per pixel",
                        "Camera rays of the direct part, spread over the pixel; 1: through its "
                        "centre; ours."),
      integer_parameter("light_samples", 4, {1.0, 65536.0}, "samples per camera ray",
                        "Samples of area lights and environment for the direct part; point and "
                        "spot lights take one ray each; ours."),
  };
  for (auto group : {light_parameters(), visibility_parameters(), gather_parameters()}) {
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
  Settings settings;
  settings.samples = parameters.integer("samples");
  settings.virtual_lights = integer("vpls");
  settings.visibility = value_of(kVisibilities, parameters.text("visibility"));
  settings.part = part_from_text(parameters.text("part"));
  settings.light_map_px = integer("light_map_px");
  settings.samples_solid_angle = parameters.text("light_sampling") == "solid_angle";
  settings.area_light_maps = integer("area_light_maps");
  settings.environment_maps = integer("environment_maps");
  settings.shadow_map_px = integer("shadow_map_px");
  settings.shadow_map_batch = integer("shadow_map_batch");
  settings.imperfect_points = integer("imperfect_points");
  settings.fills_holes = parameters.boolean("fill_holes");
  settings.interleave = integer("interleave");
  settings.clamp_radius = parameters.real("clamp_radius");
  settings.geometry_clamp = parameters.real("geometry_clamp");
  settings.compensation_rays = integer("compensation_rays");
  settings.blur = value_of(kBlurs, parameters.text("blur"));
  settings.blur_distance = parameters.real("blur_distance");
  settings.blur_normal = parameters.real("blur_normal");
  settings.area_light_map_px = integer("area_light_map_px");
  settings.camera_rays = integer("camera_rays");
  settings.light_samples = integer("light_samples");
  return settings;
}

double geometry_clamp_of(const Settings& settings, const scene::Scene& scene) {
  if (settings.geometry_clamp > 0.0) return settings.geometry_clamp;
  const double radius_m =
      settings.clamp_radius * static_cast<double>(scene::bounding_box(scene).diagonal_m());
  return radius_m > 0.0 ? 1.0 / (radius_m * radius_m) : 0.0;
}

Claims claims_of(const base::Parameters& parameters, const scene::Scene& scene) {
  const Settings settings = settings_of(parameters);
  Claims claims;
  claims.transport = Transport::one_bounce;
  claims.part = settings.part;
  const double clamp = geometry_clamp_of(settings, scene);
  if (clamp > 0.0 && settings.compensation_rays == 0) claims.geometry_clamp = clamp;
  return claims;
}

}  // namespace renderers::instant_radiosity
