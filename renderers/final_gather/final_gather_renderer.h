#pragma once

#include "renderers/contract/renderer.h"

/// Final gathers over a hierarchical radiosity solution.
///
/// Source: Scheel, Stamminger, Seidel 2002, "Grid Based Final Gather for Radiosity on Complex
/// Clustered Scenes", Computer Graphics Forum 21(3).
namespace renderers::final_gather {

/// `final-gather`: every link of every point evaluated anew, the paper's comparison.
RendererInfo full_gather_info();

/// `grid-final-gather`: senders classified at the vertices of a perspective grid, interpolated or
/// evaluated anew, steered by visible differences.
RendererInfo grid_gather_info();

/// `surface-final-gather`: the same at the vertices of the solution's patches.
RendererInfo surface_gather_info();

}  // namespace renderers::final_gather
