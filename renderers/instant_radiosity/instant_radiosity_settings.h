#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/transport.h"
#include "renderers/many_lights/picture_settings.h"
#include "renderers/scene/scene.h"

namespace renderers::instant_radiosity {

/// How a receiver learns whether it sees a virtual light.
enum class Visibility { none, shadow_map, ray, imperfect };

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct Settings : many_lights::PictureSettings {
  std::int64_t samples = 1;
  Visibility visibility = Visibility::ray;
  int shadow_map_px = 128;
  int shadow_map_batch = 64;
  int imperfect_points = 1024;
  bool keeps_imperfect_points = false;
  bool fills_holes = true;
  int compensation_rays = 0;

  bool needs_rays() const {
    return visibility == Visibility::ray || compensation_rays > 0 || part == Part::all;
  }
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
Settings settings_of(const base::Parameters& parameters);

/// One bounce of light; the clamp counts unless its loss is compensated.
Claims claims_of(const base::Parameters& parameters, const scene::Scene& scene);

}  // namespace renderers::instant_radiosity
