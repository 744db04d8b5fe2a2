#pragma once

#include "renderers/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace renderers::scene {

/// Values at the corners of a grid of cubes.
struct ScalarGrid {
  glm::vec3 origin{0.0F};
  float step_m = 1.0F;
  glm::ivec3 points{2, 2, 2};  ///< per axis, cells + 1
  std::vector<float> values;   ///< x fastest, then y

  std::size_t index(const glm::ivec3& p) const {
    return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(points.y) +
            static_cast<std::size_t>(p.y)) *
               static_cast<std::size_t>(points.x) +
           static_cast<std::size_t>(p.x);
  }
};

/// Surface where the value is `level`, front towards lower values, vertices shared, no normals.
///
/// Watertight: if every value on the grid's boundary is below `level`, each edge has exactly two
/// triangles that run through it in opposite directions.
/// Source: Lorensen and Cline 1987, "Marching Cubes", doi:10.1145/37401.37422. Differs from the
/// paper: the 256 cases are derived, not tabulated. On a face whose inside corners are opposite
/// each other, they are cut off from each other, on both cubes of the face (the paper's table
/// leaves holes there); a polygon gets no diagonal within a face of its cube, if need be by a point
/// in its middle. Vertices keep 2 percent of an edge away from the grid's points: no triangle is
/// degenerate.
Mesh marching_cubes(const ScalarGrid& grid, float level);

}  // namespace renderers::scene
