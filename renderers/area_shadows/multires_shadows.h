#pragma once

#include "renderers/contract/renderer.h"

/// Soft shadows of area lights at as many places of the picture as they need.
///
/// Source: Koa and Johan 2016, "Efficient Screenspace Rendering for Area Lights", CGI,
/// doi:10.1145/2949035.2949043, Sec. 3.1.
namespace renderers::area_shadows {

RendererInfo multires_shadows_info();

}  // namespace renderers::area_shadows
