#pragma once

#include "renderers/contract/renderer.h"

/// Direct light of area lights at every pixel, the method that others are measured by.
///
/// Source: the reference of Koa and Johan 2016, "Efficient Screenspace Rendering for Area Lights",
/// CGI, doi:10.1145/2949035.2949043, Sec. 4, Table 1 (c): 64 samples per pixel.
namespace renderers::area_shadows {

RendererInfo per_pixel_shadows_info();

}  // namespace renderers::area_shadows
