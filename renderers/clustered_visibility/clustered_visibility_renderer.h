#pragma once

#include "renderers/contract/renderer.h"

/// One bounce of light from virtual point lights that see the scene through few area lights.
/// Source: Dong, Grosch, Ritschel, Kautz and Seidel 2009, "Real-time Indirect Illumination with
/// Clustered Visibility", Vision, Modeling and Visualization (VMV) 2009.
namespace renderers::clustered_visibility {

RendererInfo renderer_info();

}  // namespace renderers::clustered_visibility
