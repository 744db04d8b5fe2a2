#pragma once

#include "renderers/contract/renderer.h"

/// One bounce of light through a coarse volume, fed by samples on surfaces that gather the lights.
///
/// Source: Koa and Johan 2016, "Efficient Screenspace Rendering for Area Lights", CGI,
/// doi:10.1145/2949035.2949043, Sec. 3.2, on Kaplanyan and Dachsbacher 2010, "Cascaded Light
/// Propagation Volumes for Real-Time Indirect Illumination", doi:10.1145/1730804.1730821.
namespace renderers::light_propagation {

RendererInfo renderer_info();

}  // namespace renderers::light_propagation
