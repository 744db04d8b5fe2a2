#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/transport.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::path_tracing {

/// How light is looked for at each surface.
enum class Sampling {
  mis,  ///< both strategies, combined by the power heuristic
  nee,  ///< next-event estimation only: one light chosen per surface
  bsdf  ///< reflected rays only; point and spot lights, which no ray hits, by NEE
};

/// Where in a pixel camera rays go.
enum class PixelFilter {
  box,    ///< anywhere: the mean over the pixel
  centre  ///< through its centre, as techniques with one surface per pixel look
};

/// Parameters of the renderer, typed. Meanings: `parameter_specs`.
struct PathSettings {
  std::int64_t samples = 64;
  Claims claims;
  int max_depth = 0;
  int roulette_depth = 4;
  Sampling sampling = Sampling::mis;
  bool light_rays = true;
  ray_tracing::SequenceKind sampler = ray_tracing::SequenceKind::sobol;
  PixelFilter pixel = PixelFilter::box;

  /// Greatest number of surfaces a path may meet, from `max_depth` and the transport.
  int surface_limit() const;
};

std::vector<base::ParameterSpec> parameter_specs();
std::vector<base::Preset> presets();
Claims claims_of(const base::Parameters& parameters);
PathSettings settings_of(const base::Parameters& parameters);

}  // namespace renderers::path_tracing
