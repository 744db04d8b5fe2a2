#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/transport.h"
#include "renderers/scene/scene.h"

namespace renderers::instant_radiosity {

/// How a receiver learns whether it sees a virtual light.
enum class Visibility { none, shadow_map, ray, imperfect };

/// How a receiver's neighbours' shares of the lights are combined.
enum class Blur { none, box, separable, centred };

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings {
  std::int64_t samples = 1;
  int virtual_lights = 1024;
  Visibility visibility = Visibility::ray;
  Part part = Part::all;
  // lights
  int light_map_px = 512;
  int area_light_map_px = 128;
  bool samples_solid_angle = true;
  int area_light_maps = 16;
  int environment_maps = 32;
  // visibility
  int shadow_map_px = 128;
  int shadow_map_batch = 64;
  int imperfect_points = 1024;
  bool fills_holes = true;
  // gather
  int interleave = 8;
  double clamp_radius = 0.03;
  double geometry_clamp = 0.0;
  int compensation_rays = 0;
  // filter
  Blur blur = Blur::centred;
  double blur_distance = 0.1;
  double blur_normal = 0.8;
  // direct light
  int camera_rays = 4;
  int light_samples = 4;

  bool needs_rays() const {
    return visibility == Visibility::ray || compensation_rays > 0 || part == Part::all;
  }
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
Settings settings_of(const base::Parameters& parameters);

/// Bound of the geometry term in force, 1/m2; 0: none. `geometry_clamp` if it is set, else
/// 1 / (clamp_radius x diagonal)^2 of the scene's bounding box.
double geometry_clamp_of(const Settings& settings, const scene::Scene& scene);

/// One bounce of light; the clamp counts unless its loss is compensated.
Claims claims_of(const base::Parameters& parameters, const scene::Scene& scene);

}  // namespace renderers::instant_radiosity
