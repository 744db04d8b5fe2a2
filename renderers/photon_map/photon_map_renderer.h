#pragma once

#include "renderers/contract/renderer.h"

namespace renderers::photon_map {

/// The renderer `photon-map`: photons from the lights, and a final gather into them.
///
/// Source: Jensen 1996, "Global Illumination using Photon Maps", Rendering Techniques '96,
/// doi:10.1007/978-3-7091-7484-5_3.
RendererInfo renderer_info();

}  // namespace renderers::photon_map
