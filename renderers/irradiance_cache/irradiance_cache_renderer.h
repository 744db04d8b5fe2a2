#pragma once

#include "renderers/contract/renderer.h"

namespace renderers::irradiance_cache {

/// The renderer `irradiance-cache`: indirect irradiance at few points, interpolated between them.
///
/// Sources: Ward, Rubinstein, Clear 1988, "A Ray Tracing Solution for Diffuse Interreflection",
/// doi:10.1145/54852.378490; Ward and Heckbert 1992, "Irradiance Gradients", EGWR.
RendererInfo renderer_info();

}  // namespace renderers::irradiance_cache
