#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "perception/viewing_conditions.h"
#include "renderers/clustered_visibility/area_visibility.h"
#include "renderers/clustered_visibility/convolution_maps.h"
#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/contract/transport.h"
#include "renderers/many_lights/picture_settings.h"
#include "renderers/scene/scene.h"
#include "renderers/shadow_maps/map_filler.h"

namespace renderers::clustered_visibility {

/// How a receiver learns how much of a virtual area light it sees.
enum class Visibility {
  oracle,  ///< mean visibility of its virtual point lights, by rays: the error of clustering alone
  hard,
  pcf,
  cssm,
  msm
};

/// How the number of area lights follows the picture (cluster_growth.h).
struct GrowthSettings {
  bool is_on = false;
  int first = 4;            ///< area lights
  double tolerance = 0.02;  ///< share of pixels that may still change visibly
  int preview_px = 32;      ///< longer side of the preview
  perception::ViewingConditions viewing = perception::default_viewing_conditions();
};

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings : many_lights::PictureSettings {
  int bounces = 1;  ///< sets of lights: those of the light sources, then those re-emitted
  Visibility visibility = Visibility::msm;
  ClusterSettings clusters{};
  bool clips_more = false;  ///< than was asked for: which way projected vertices face is not known
  GrowthSettings growth{};
  int shadow_map_px = 256;
  shadow_maps::DepthBackend depth = shadow_maps::DepthBackend::exact;
  shadow_maps::VertexMapSettings vertex_maps{};
  ConvolutionSettings convolution{};
  AreaVisibilitySettings area{};
  int only_val = -1;  ///< -1: all
  bool shows_lights = false;
  int shown_vals = 0;

  bool has_maps() const { return visibility != Visibility::oracle; }
  bool needs_rays() const { return visibility == Visibility::oracle || part == Part::all; }
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();

/// @throws base::InputError if there are more area lights than point lights, if the side of the
///   maps is no power of two, if `adaptive` is asked for with rays or warm clusters, or if
///   `only_val` names none or goes with `adaptive` or several bounces
Settings settings_of(const base::Parameters& parameters);

/// One bounce of light or, with more of them, any number, the geometry term bounded.
Claims claims_of(const base::Parameters& parameters, const scene::Scene& scene);

}  // namespace renderers::clustered_visibility
