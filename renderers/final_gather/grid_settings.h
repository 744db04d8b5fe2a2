#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/final_gather/gather_settings.h"
#include "renderers/final_gather/grid_anchors.h"
#include "renderers/final_gather/vertex_classes.h"
#include "renderers/final_gather/view_perception.h"

namespace renderers::final_gather {

/// Parameters of `grid-final-gather` beyond those of all gathers, typed.
struct GridSettings {
  GridAnchors::Settings grid;
  ClassSettings classes;
  PerceptionSettings perception;
};

/// With those of all gathers.
std::vector<base::ParameterSpec> grid_parameters();
std::vector<base::Preset> grid_presets();
GridSettings grid_settings_of(const base::Parameters& parameters);

}  // namespace renderers::final_gather
