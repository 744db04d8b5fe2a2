#pragma once

#include "renderers/contract/renderer.h"

/// Hierarchical radiosity with clusters, shown directly.
///
/// Sources: Hanrahan, Salzman, Aupperle 1991, "A Rapid Hierarchical Radiosity Algorithm",
/// doi:10.1145/122718.122740; Sillion 1995, "A Unified Hierarchical Algorithm for Global
/// Illumination with Scattering Volumes and Object Clusters", doi:10.1109/2945.466719. The first
/// pass and the preview of Scheel, Stamminger, Seidel 2002, "Grid Based Final Gather for Radiosity
/// on Complex Clustered Scenes", Computer Graphics Forum 21(3).
namespace renderers::radiosity {

RendererInfo renderer_info();

}  // namespace renderers::radiosity
