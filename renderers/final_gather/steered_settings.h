#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/final_gather/gather_settings.h"
#include "renderers/final_gather/grid_anchors.h"
#include "renderers/final_gather/hit_rule.h"
#include "renderers/final_gather/sender_classes.h"
#include "renderers/final_gather/surface_choice.h"
#include "renderers/final_gather/surface_classes.h"
#include "renderers/final_gather/surface_vertices.h"
#include "renderers/final_gather/view_perception.h"

namespace renderers::final_gather {

/// Parameters of the gathers that are steered by what is seen, beyond those of all gathers, typed.
struct SteeredSettings {
  GridSettings grid;
  HitRule hit_rule = HitRule::surface;
  SurfaceUse surface = SurfaceUse::finely_cut;
  DecidedFor decided_for = DecidedFor::vertices;
  VertexVisibility vertex_visibility = VertexVisibility::rays;
  ClassSettings classes;
  PerceptionSettings perception;
};

/// With those of all gathers.
std::vector<base::ParameterSpec> grid_parameters();
std::vector<base::Preset> grid_presets();
SteeredSettings grid_settings_of(const base::Parameters& parameters);

std::vector<base::ParameterSpec> surface_parameters();
std::vector<base::Preset> surface_presets();
SteeredSettings surface_settings_of(const base::Parameters& parameters);

}  // namespace renderers::final_gather
