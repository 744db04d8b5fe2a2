#pragma once

#include "renderers/contract/renderer.h"

/// Percentage-closer soft shadows (`soft_shadows/percentage_closer.h`) of what the camera sees.
///
/// Source: Fernando 2005, "Percentage-Closer Soft Shadows", SIGGRAPH 2005 Sketches,
/// doi:10.1145/1187112.1187153 (recalled).
namespace renderers::area_shadows {

RendererInfo pcss_shadows_info();

}  // namespace renderers::area_shadows
