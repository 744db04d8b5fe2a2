#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/indirect_view/view_settings.h"
#include "renderers/irradiance_cache/cached_light.h"

namespace renderers::irradiance_cache {

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings {
  indirect_view::ViewSettings view;
  CacheSettings cache;             ///< without the spacing in metres
  double least_spacing = 0.02;     ///< share of the scene's diagonal
  double greatest_spacing = 0.25;  ///< share of the scene's diagonal
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
/// `one_bounce` if paths end at the first surface behind a record, else `diffuse`.
Claims claims_of(const base::Parameters& parameters);
/// @throws base::InputError if the least spacing is above the greatest
Settings settings_of(const base::Parameters& parameters);

}  // namespace renderers::irradiance_cache
