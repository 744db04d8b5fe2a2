#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
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
  cssm
};

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings : many_lights::PictureSettings {
  Visibility visibility = Visibility::cssm;
  ClusterSettings clusters{};
  int shadow_map_px = 256;
  shadow_maps::DepthBackend depth = shadow_maps::DepthBackend::exact;
  shadow_maps::VertexMapSettings vertex_maps{};
  ConvolutionSettings convolution{};
  AreaVisibilitySettings area{};
  bool shows_lights = false;
  int shown_vals = 0;

  bool has_maps() const { return visibility != Visibility::oracle; }
  bool needs_rays() const { return visibility == Visibility::oracle || part == Part::all; }
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();

/// @throws base::InputError if there are more area lights than point lights, or the side of the
/// maps
///   is no power of two
Settings settings_of(const base::Parameters& parameters);

/// One bounce of light, its geometry term bounded.
Claims claims_of(const base::Parameters& parameters, const scene::Scene& scene);

}  // namespace renderers::clustered_visibility
