#pragma once

#include "renderers/contract/renderer.h"

namespace renderers::hemisphere_gather {

/// The renderer `hemisphere-gather`: a solution of hierarchical radiosity, gathered at every camera
/// ray by cosine-distributed rays over the hemisphere.
///
/// Sources: Reichert 1992, "A Two-Pass Radiosity Method Driven by Lights and Viewer Position",
/// M.S. thesis, Cornell University (the gather; recalled); Scheel, Stamminger, Seidel 2002, "Grid
/// Based Final Gather for Radiosity on Complex Clustered Scenes", Computer Graphics Forum 21(3)
/// (the solution, and what it is compared with).
RendererInfo renderer_info();

}  // namespace renderers::hemisphere_gather
