#include "renderers/many_lights/picture_settings.h"

#include <array>
#include <iterator>
#include <utility>

#include "renderers/contract/choice_names.h"

namespace renderers::many_lights {

namespace {

using base::choice_parameter;
using base::integer_parameter;
using base::ParameterSpec;
using base::real_parameter;

constexpr double kMostMapSide_px = 8192;

constexpr std::array kBlurs{std::pair{"none", Blur::none}, std::pair{"box", Blur::box},
                            std::pair{"separable", Blur::separable},
                            std::pair{"centred", Blur::centred}};

std::vector<ParameterSpec> light_parameters(double most_lights) {
  return {
      integer_parameter("vpls", 1024, {1.0, most_lights}, "virtual lights",
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

std::vector<ParameterSpec> direct_parameters() {
  return {
      choice_parameter("part", {"all", "indirect"}, "all",
                       "indirect: without emission seen by the camera and direct light."),
      integer_parameter("camera_rays", 4, {1.0, 65536.0}, "rays per pixel",
                        "Camera rays of the direct part, spread over the pixel; 1: through its "
                        "centre; ours."),
      integer_parameter("light_samples", 4, {1.0, 65536.0}, "samples per camera ray",
                        "Samples of area lights and environment for the direct part; point and "
                        "spot lights take one ray each; ours."),
  };
}

}  // namespace

std::vector<ParameterSpec> picture_parameters(double most_lights) {
  std::vector<ParameterSpec> specs = direct_parameters();
  for (auto group : {light_parameters(most_lights), gather_parameters()}) {
    specs.insert(specs.end(), std::make_move_iterator(group.begin()),
                 std::make_move_iterator(group.end()));
  }
  return specs;
}

PictureSettings picture_settings_of(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  PictureSettings settings;
  settings.part = part_from_text(parameters.text("part"));
  settings.virtual_lights = integer("vpls");
  settings.light_map_px = integer("light_map_px");
  settings.area_light_map_px = integer("area_light_map_px");
  settings.samples_solid_angle = parameters.text("light_sampling") == "solid_angle";
  settings.area_light_maps = integer("area_light_maps");
  settings.environment_maps = integer("environment_maps");
  settings.interleave = integer("interleave");
  settings.clamp_radius = parameters.real("clamp_radius");
  settings.geometry_clamp = parameters.real("geometry_clamp");
  settings.blur = value_of(kBlurs, parameters.text("blur"));
  settings.blur_distance = parameters.real("blur_distance");
  settings.blur_normal = parameters.real("blur_normal");
  settings.camera_rays = integer("camera_rays");
  settings.light_samples = integer("light_samples");
  return settings;
}

GeneratorSettings generator_settings(const PictureSettings& settings) {
  GeneratorSettings generator;
  generator.light_count = settings.virtual_lights;
  generator.map_size_px = settings.light_map_px;
  generator.area_map_size_px = settings.area_light_map_px;
  generator.environment_map_size_px = settings.area_light_map_px;
  generator.emitters.sampling =
      settings.samples_solid_angle ? LightSampling::solid_angle : LightSampling::map;
  generator.emitters.area_light_points = settings.area_light_maps;
  generator.emitters.environment_directions = settings.environment_maps;
  return generator;
}

BlurSettings blur_settings(const PictureSettings& settings, float diagonal_m) {
  assert(settings.blur != Blur::none);
  BlurSettings blur;
  blur.kind = settings.blur == Blur::box         ? BlurKind::box
              : settings.blur == Blur::separable ? BlurKind::separable
                                                 : BlurKind::centred;
  blur.interleave = settings.interleave;
  blur.alpha_m = static_cast<float>(settings.blur_distance) * diagonal_m;
  blur.beta = static_cast<float>(settings.blur_normal);
  return blur;
}

double geometry_clamp_of(const PictureSettings& settings, const scene::Scene& scene) {
  if (settings.geometry_clamp > 0.0) return settings.geometry_clamp;
  const double radius_m =
      settings.clamp_radius * static_cast<double>(scene::bounding_box(scene).diagonal_m());
  return radius_m > 0.0 ? 1.0 / (radius_m * radius_m) : 0.0;
}

}  // namespace renderers::many_lights
