#pragma once

#include <cstdint>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/transport.h"
#include "renderers/ray_bundles/bundle_transport.h"
#include "renderers/ray_bundles/soft_direct_light.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// What finds the crossings of bundles' lines.
enum class Backend {
  automatic,  ///< a device that is hardware, else the CPU
  cpu,
  opengl
};

/// Where light comes from that meets one surface.
enum class DirectMode {
  bundles,  ///< from bundles that meet emitters; point and spot lights by shadow rays all the same
  pcss,     ///< of area lights by `SoftDirectLight`, for texels and pixels; bundles carry the rest
  next_event  ///< from samples on the lights, for texels and pixels; bundles carry the rest
};

/// Where lobes act.
enum class GlossyPaths {
  last_surface,  ///< at the surface that the camera sees alone
  chain          ///< at all surfaces: `GlossyTransfer`
};

/// How the lobe that the camera sees finds its light.
enum class FinalGlossy {
  ray,     ///< by a ray along it that looks at the atlas; by bundles what other lobes send
  bundles  ///< by bundles: `GlossyView`
};

/// Which light is in the picture.
enum class LightPaths {
  all,
  direct  ///< what meets one surface
};

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings {
  std::int64_t samples = 1024;
  Backend backend = Backend::automatic;
  Part part = Part::all;
  LightPaths paths = LightPaths::all;
  DirectMode direct = DirectMode::next_event;
  GlossyPaths glossy = GlossyPaths::last_surface;
  FinalGlossy final_glossy = FinalGlossy::ray;
  double most_exponent = 200.0;  ///< of lobes that bundles light
  TransportSettings transport;   ///< without device, seed and plan
  std::int64_t bounces = 6;      ///< jacobi only
  texel_atlas::AtlasSettings atlas;
  int light_samples = 4;
  SoftLightSettings soft;             ///< pcss only
  int camera_rays = 4;                ///< per pixel and pass
  std::int64_t pass_directions = 32;  ///< directions per pass
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
Settings settings_of(const base::Parameters& parameters);
/// True if bundles light lobes.
inline bool has_glossy_bundles(const Settings& settings) {
  return settings.glossy == GlossyPaths::chain || settings.final_glossy == FinalGlossy::bundles;
}
/// Any number of diffuse interreflections; all paths if lobes act at all surfaces.
Claims claims_of(const base::Parameters& parameters);

}  // namespace renderers::ray_bundles
