#pragma once

#include <string>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/transport.h"
#include "renderers/many_lights/geometry_aware_blur.h"
#include "renderers/many_lights/virtual_light_generator.h"
#include "renderers/scene/scene.h"

namespace renderers::many_lights {

/// How a receiver's neighbours' shares of the lights are combined.
enum class Blur { none, box, separable, centred };

/// What pictures by virtual lights have in common, typed. Meanings: `picture_parameters`.
struct PictureSettings {
  Part part = Part::all;
  // lights
  int virtual_lights = 1024;
  int light_map_px = 512;
  int area_light_map_px = 128;
  bool samples_solid_angle = true;
  int area_light_maps = 16;
  int environment_maps = 32;
  // gather
  int interleave = 8;
  double clamp_radius = 0.03;
  double geometry_clamp = 0.0;
  // filter
  Blur blur = Blur::centred;
  double blur_distance = 0.1;
  double blur_normal = 0.8;
  // direct light
  int camera_rays = 4;
  int light_samples = 4;

  bool has_blur() const { return blur != Blur::none && interleave > 1; }
};

/// Their declarations. @param most_lights  greatest value of vpls
std::vector<base::ParameterSpec> picture_parameters(double most_lights);
/// From the values of `picture_parameters`.
PictureSettings picture_settings_of(const base::Parameters& parameters);

GeneratorSettings generator_settings(const PictureSettings& settings);
/// @param diagonal_m  of the scene's bounds; the settings must have a blur
BlurSettings blur_settings(const PictureSettings& settings, float diagonal_m);

/// Bound of the geometry term in force, 1/m2; 0: none. `geometry_clamp` if it is set, else
/// 1 / (clamp_radius x diagonal)^2 of the scene's bounding box.
double geometry_clamp_of(const PictureSettings& settings, const scene::Scene& scene);

}  // namespace renderers::many_lights
