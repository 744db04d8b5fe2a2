#pragma once

#include "renderers/contract/renderer.h"

/// Soft shadows of area lights at fragments that are refined where neighbours see other parts of
/// the lights: the method that `multires-shadows` is compared with.
///
/// Source: Nichols, Penmatsa, Wyman 2010, "Interactive, Multiresolution Image-Space Rendering for
/// Dynamic Area Lighting", doi:10.1111/j.1467-8659.2010.01723.x, as Koa and Johan 2016,
/// doi:10.1145/2949035.2949043 describe it.
namespace renderers::area_shadows {

RendererInfo nichols_shadows_info();

}  // namespace renderers::area_shadows
