#pragma once

#include <cstdint>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/indirect_view/view_settings.h"
#include "renderers/photon_map/photon_light.h"
#include "renderers/photon_map/photon_tracing.h"

namespace renderers::photon_map {

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings {
  indirect_view::ViewSettings view;
  indirect_view::HemisphereRays gather;
  PhotonTracingSettings tracing;
  DensitySettings density;   ///< without the radius in metres
  double most_radius = 0.1;  ///< share of the scene's diagonal
  int precompute_every = 4;  ///< 0: estimates at every hit
  double near_radii = 1.0;   ///< mean radii of an estimate
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
Settings settings_of(const base::Parameters& parameters);

}  // namespace renderers::photon_map
