#pragma once

#include "renderers/scene/scene.h"

#include <cstddef>

/// More triangles on the same surface.
///
/// Rivara 1984, "Algorithms for refining triangular grids suitable for adaptive and multigrid
/// techniques", doi:10.1002/nme.1620200412: longest-edge bisection; read in other sources. The
/// least angle never falls below half of the one at the start: Rosenberg and Stenger 1975, "A Lower
/// Bound on the Angles of Triangles Constructed by Bisecting the Longest Side", Mathematics of
/// Computation 29(130), 390-395, abstract.
namespace renderers::scene {

/// Halves the longest edge of the mesh, and with it every triangle that has this edge, until there
/// are at least `triangles`. The longest edge of all is the longest one of each of its triangles,
/// so no vertex ever lies inside an edge. Vertices at exactly the same position count as one: an
/// edge between different normals or uvs is halved on both sides at the same place.
///
/// Positions, uvs and normals (then made unit length) are the means of an edge's ends: surface and
/// area stay as they are. Among edges of the same length the one of the earlier vertices comes
/// first.
/// @param triangles  a mesh that has as many already stays as it is; usually exactly met or one
///   more, since most edges have two triangles
void subdivide_to(Mesh& mesh, std::size_t triangles);

}  // namespace renderers::scene
