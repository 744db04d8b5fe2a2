#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/scene/scene.h"

namespace renderers::shadow_maps {

/// Triangles in world space.
struct TriangleList {
  std::vector<glm::vec3> vertices;  ///< m
  std::vector<glm::uvec3> triangles;
};

/// A scene's triangles in pieces without long edges.
///
/// A triangle with too long an edge is halved at the middle of its longest one, and so on (Rivara
/// 1984, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques",
/// doi:10.1002/nme.1620200412, recalled). Whether an edge is cut, and where, follows from its ends
/// alone, so that pieces that meet along an edge have the same vertices there.
///
/// @param longest_edge_m  0 or less: nothing is cut
/// @param most            pieces
/// @return nothing if there were more pieces than `most`
std::optional<TriangleList> tessellated(const scene::Scene& scene, float longest_edge_m,
                                        std::size_t most);

}  // namespace renderers::shadow_maps
