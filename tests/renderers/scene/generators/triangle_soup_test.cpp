#include "renderers/scene/generators/triangle_soup.h"

#include "tests/renderers/scene/generators/mesh_facts.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace renderers::scene {
namespace {

TEST(TriangleSoup, BoxIsClosedWithItsFrontOutside) {
  TriangleSoup soup;
  soup.add_box({1, 2, 3}, {2, 4, 6});
  const Mesh mesh = soup.to_mesh(30.0F);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_EQ(mesh.positions.size(), 24U) << "right angles are creases";
  EXPECT_NEAR(tests::volume_m3(mesh), 6.0, 1e-5);
  EXPECT_NEAR(tests::area_m2(mesh), 22.0, 1e-5);
  EXPECT_EQ(tests::turned_normals(mesh), 0);
}

TEST(TriangleSoup, OpenSidesAreTheNamedOnes) {
  TriangleSoup soup;
  soup.add_box({0, 0, 0}, {1, 2, 3}, kLeastY | kGreatestX);
  EXPECT_EQ(soup.size(), 8U);
  const Mesh mesh = soup.to_mesh(30.0F);
  for (const glm::vec3& normal : mesh.normals) {
    EXPECT_GE(normal.y, 0.0F);
    EXPECT_LE(normal.x, 0.0F);
  }
}

TEST(TriangleSoup, FlatAnglesAreSmoothSharpOnesAreNot) {
  // Two quads that meet at 20 degrees.
  const float rise = std::tan(glm::radians(20.0F));
  TriangleSoup soup;
  soup.add_polygon({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  soup.add_polygon({{1, 0, 0}, {1, 0, 1}, {2, rise, 1}, {2, rise, 0}});
  EXPECT_EQ(soup.to_mesh(30.0F).positions.size(), 6U);
  EXPECT_EQ(soup.to_mesh(10.0F).positions.size(), 8U);
  const Mesh smooth = soup.to_mesh(30.0F);
  bool has_mean = false;
  const glm::vec3 mean(-std::sin(glm::radians(10.0F)), std::cos(glm::radians(10.0F)), 0.0F);
  for (const glm::vec3& n : smooth.normals) has_mean = has_mean || glm::distance(n, mean) < 1e-5F;
  EXPECT_TRUE(has_mean);
}

TEST(TriangleSoup, TrianglesWithoutAreaAreLeftOut) {
  TriangleSoup soup;
  soup.add_triangle({{0, 0, 0}, {}}, {{1, 1, 1}, {}}, {{2, 2, 2}, {}});
  soup.add_triangle({{0, 0, 0}, {}}, {{1, 1, 1}, {}}, {{1, 1, 1}, {}});
  EXPECT_EQ(soup.size(), 0U);
}

TEST(TriangleSoup, AppendedPiecesAreMoved) {
  TriangleSoup piece;
  piece.add_box(glm::vec3(0.0F), glm::vec3(1.0F));
  TriangleSoup soup;
  soup.append(piece, glm::translate(glm::mat4(1.0F), {0, 5, 0}));
  for (const glm::vec3& p : soup.to_mesh(30.0F).positions) EXPECT_GE(p.y, 5.0F);
}

}  // namespace
}  // namespace renderers::scene
