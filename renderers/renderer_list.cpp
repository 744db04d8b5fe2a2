#include "renderers/renderer_list.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "renderers/area_shadows/grid_shadows.h"
#include "renderers/area_shadows/multires_shadows.h"
#include "renderers/area_shadows/nichols_shadows.h"
#include "renderers/area_shadows/pcss_shadows.h"
#include "renderers/area_shadows/per_pixel_shadows.h"
#include "renderers/blank/blank_renderer.h"
#include "renderers/clustered_visibility/clustered_visibility_renderer.h"
#include "renderers/final_gather/final_gather_renderer.h"
#include "renderers/hemisphere_gather/hemisphere_gather_renderer.h"
#include "renderers/instant_radiosity/instant_radiosity_renderer.h"
#include "renderers/irradiance_cache/irradiance_cache_renderer.h"
#include "renderers/light_propagation/light_propagation_renderer.h"
#include "renderers/path_tracing/path_renderer.h"
#include "renderers/photon_map/photon_map_renderer.h"
#include "renderers/radiosity/radiosity_renderer.h"
#include "renderers/ray_bundles/ray_bundles_renderer.h"
#include "renderers/sum/sum_renderer.h"

namespace renderers {

namespace {

template <typename Entries>
std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

/// The entry of a table by name, or the sentence that lists the names as an error.
template <typename Entries>
const auto& find_entry(const Entries& entries, std::string_view name, const std::string& kind,
                       const base::Place& place) {
  for (const auto& entry : entries) {
    if (base::is_same_name(entry.name, name)) return entry;
  }
  throw base::InputError(place, base::unknown_name(kind, name, names_of(entries)));
}

/// Direct light of `multires-shadows` and the bounce of `light-propagation`.
RendererInfo area_lights_info() {
  static constexpr Claims kClaims{Transport::one_bounce, Part::all, std::nullopt};
  std::vector<sum::Part> parts;
  parts.push_back({area_shadows::multires_shadows_info(), "shadows", "shadow", {}});
  parts.push_back({light_propagation::renderer_info(),
                   "volume",
                   "transport",
                   {{"part", base::ParameterValue(std::string("indirect"))}}});
  return sum::renderer_info(
      {"area-lights",
       "Direct light at fragments of the picture and one bounce through a coarse volume.",
       "Koa and Johan 2016, doi:10.1145/2949035.2949043, Fig. 1", kClaims},
      std::move(parts), [](const base::Parameters&, const scene::Scene&) { return kClaims; });
}

}  // namespace

std::span<const RendererInfo> renderer_list() {
  static const std::array<RendererInfo, 19> list{blank::renderer_info(),
                                                 path_tracing::renderer_info(),
                                                 instant_radiosity::renderer_info(),
                                                 clustered_visibility::renderer_info(),
                                                 ray_bundles::renderer_info(),
                                                 radiosity::renderer_info(),
                                                 final_gather::full_gather_info(),
                                                 final_gather::grid_gather_info(),
                                                 final_gather::surface_gather_info(),
                                                 hemisphere_gather::renderer_info(),
                                                 irradiance_cache::renderer_info(),
                                                 photon_map::renderer_info(),
                                                 area_shadows::multires_shadows_info(),
                                                 area_shadows::nichols_shadows_info(),
                                                 area_shadows::per_pixel_shadows_info(),
                                                 area_shadows::grid_shadows_info(),
                                                 area_shadows::pcss_shadows_info(),
                                                 light_propagation::renderer_info(),
                                                 area_lights_info()};
  return list;
}

const RendererInfo& find_renderer(std::string_view name, const base::Place& place) {
  return find_entry(renderer_list(), name, "renderer", place);
}

const base::Preset& find_preset(const RendererInfo& info, std::string_view name,
                                const base::Place& place) {
  return find_entry(info.presets, name, info.name + " preset", place);
}

std::vector<std::string> unsupported_features(const RendererInfo& info, const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const Feature feature : scene::features_of(scene)) {
    if (std::ranges::find(info.supports, feature) == info.supports.end()) {
      names.push_back(scene::to_string(feature));
    }
  }
  return names;
}

}  // namespace renderers
