#pragma once

#include "renderers/scene/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <vector>

/// Pieces that are added to a mesh with normals and uvs as they are: no welding afterwards, so that
/// hundreds of thousands of triangles take little time.
namespace renderers::scene {

/// A flat parallelogram corner, +a, +a + b, +b; front = cross(a, b). uv in periods of
/// `kTexturePeriod_m` along its edges.
void add_parallelogram(Mesh& mesh, const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b);

/// Box, front outside. @param to_place  rotation and translation
void add_cuboid(Mesh& mesh, const glm::vec3& least, const glm::vec3& greatest,
                const glm::mat4& to_place);

/// Ellipsoid with smooth normals, front outside. @param segments  around, half as many from pole to
/// pole, >= 4
void add_ellipsoid(Mesh& mesh, const glm::vec3& center, const glm::vec3& radii_m, int segments);

/// Cone frustum or cylinder between two points, its ends closed if asked for.
struct TubeShape {
  glm::vec3 from{0.0F};
  glm::vec3 to{0.0F, 1.0F, 0.0F};
  float from_radius_m = 0.1F;
  float to_radius_m = 0.1F;
  int around = 8;  ///< >= 3
  bool has_ends = true;
};
void add_tube(Mesh& mesh, const TubeShape& shape);

/// A book that stands on y = 0, its spine towards +z, the middle of its back at the origin.
struct BookShape {
  float thickness_m = 0.03F;  ///< along x
  float height_m = 0.24F;
  float depth_m = 0.18F;
  int spine_segments = 8;  ///< of the rounded spine, >= 1
};
/// Triangles of a book, cover and pages together.
constexpr int book_triangles(int spine_segments) { return 4 * spine_segments + 8; }
/// @param cover  receives boards and spine  @param pages  receives top, bottom and fore-edge
void add_book(Mesh& cover, Mesh& pages, const BookShape& shape, const glm::mat4& to_place);

}  // namespace renderers::scene
