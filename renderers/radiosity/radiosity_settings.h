#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/transport.h"
#include "renderers/element_hierarchy/radiosity_solver.h"
#include "renderers/element_hierarchy/shown_light.h"

namespace renderers::radiosity {

/// Where the light comes from that a pixel shows.
enum class DirectMode {
  solution,   ///< emission's light from the solution; point and spot lights by shadow rays
  next_event  ///< from samples on the lights at every camera ray; the solution gives the rest
};

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings {
  element_hierarchy::SolverSettings solver;
  element_hierarchy::Shading shading = element_hierarchy::Shading::smooth;
  DirectMode direct = DirectMode::next_event;
  Part part = Part::all;
  int camera_rays = 16;
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
Settings settings_of(const base::Parameters& parameters);
/// Any number of diffuse interreflections.
Claims claims_of(const base::Parameters& parameters);

}  // namespace renderers::radiosity
