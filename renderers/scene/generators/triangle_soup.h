#pragma once

#include "renderers/scene/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace renderers::scene {

/// Position (metres) and texture coordinate of a triangle's corner.
struct Corner {
  glm::vec3 position{0.0F};
  glm::vec2 uv{0.0F};
};

/// Sides of a box that is not closed, to be added up.
enum BoxSide : unsigned {
  kNoSide = 0U,
  kLeastX = 1U,
  kGreatestX = 2U,
  kLeastY = 4U,
  kGreatestY = 8U,
  kLeastZ = 16U,
  kGreatestZ = 32U
};

/// Metres that one period of a texture covers on surfaces with planar coordinates.
inline constexpr float kTexturePeriod_m = 2.0F;

/// Triangles piece by piece, each with its own corners; normals are made at the end.
///
/// All are counter-clockwise seen from the front. Triangles without area are left out, so that
/// grids may collapse to a point at an edge.
class TriangleSoup {
 public:
  std::size_t size() const { return corners_.size() / 3; }

  void add_triangle(const Corner& a, const Corner& b, const Corner& c);
  void add_quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d);
  /// A flat polygon's fan from its first corner; uv along the two axes it faces least.
  void add_polygon(const std::vector<glm::vec3>& corners);
  /// Axis-aligned box, front outside. @param open_sides  sum of BoxSide
  void add_box(const glm::vec3& least, const glm::vec3& greatest, unsigned open_sides = kNoSide);
  /// (columns + 1) x (rows + 1) points, front = cross(along columns, along rows).
  void add_grid(int columns, int rows, const std::function<Corner(int, int)>& point);
  /// @param to_place  without mirroring
  void append(const TriangleSoup& other, const glm::mat4& to_place);

  /// Welds equal corners. A corner's normal is the mean of those faces at its position that are
  /// within `crease_deg` of its own face, weighted by their angle there.
  Mesh to_mesh(float crease_deg) const;

 private:
  std::vector<Corner> corners_;  ///< three per triangle
};

}  // namespace renderers::scene
