#pragma once

#include "renderers/contract/renderer.h"

/// One bounce of light from virtual point lights.
///
/// Sources: Keller 1997, "Instant Radiosity", doi:10.1145/258734.258769; Dachsbacher and Stamminger
/// 2005, "Reflective Shadow Maps", doi:10.1145/1053427.1053460; Ritschel et al. 2008, "Imperfect
/// Shadow Maps for Efficient Computation of Indirect Illumination", doi:10.1145/1409060.1409082;
/// Kollig and Keller 2004, "Illumination in the Presence of Weak Singularities",
/// doi:10.1007/3-540-31186-6_15; Dong et al. 2009, "Real-time Indirect Illumination with Clustered
/// Visibility", VMV (sizes of the sets, interleaving and blur).
namespace renderers::instant_radiosity {

RendererInfo renderer_info();

}  // namespace renderers::instant_radiosity
