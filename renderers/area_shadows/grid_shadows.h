#pragma once

#include "renderers/contract/renderer.h"

/// Soft shadows of area lights on a uniform grid of pixels, interpolated along surfaces: what a
/// refinement has to be better than. Ours; the weights are a joint bilateral filter's with a sharp
/// range (Kopf et al. 2007, "Joint Bilateral Upsampling", doi:10.1145/1276377.1276497).
namespace renderers::area_shadows {

RendererInfo grid_shadows_info();

}  // namespace renderers::area_shadows
