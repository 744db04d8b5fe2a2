#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/transport.h"
#include "renderers/light_propagation/propagation.h"
#include "renderers/light_propagation/surface_samples.h"

namespace renderers::light_propagation {

/// Where the volume's light comes from.
enum class Sources {
  poisson,  ///< samples on all surfaces that gather all lights
  rsm       ///< what point and spot lights shine on
};

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings {
  Part part = Part::all;
  int cells = 32;
  float grid_shift = 0.0F;  ///< cells, along all axes
  PropagationSettings propagation;
  SampleSettings samples;
  int light_points = 16;
  Sources sources = Sources::poisson;
  int rsm_rays = 65536;  ///< per light
  bool has_geometry_volume = true;
  Lookup lookup = Lookup::face_flux;
  int light_samples = 16;
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
/// @throws base::InputError if light_points is not a power of two
Settings settings_of(const base::Parameters& parameters);
/// One bounce of light.
Claims claims_of(const base::Parameters& parameters);

}  // namespace renderers::light_propagation
