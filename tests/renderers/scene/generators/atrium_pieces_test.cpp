#include "renderers/scene/generators/atrium_pieces.h"

#include "tests/renderers/scene/generators/mesh_facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kCrease_deg = 38.0F;

TEST(AtriumPieces, LatheOfACylinder) {
  TriangleSoup soup;
  add_lathe(soup, {{0.5F, 0.0F}, {0.5F, 2.0F}}, 96);
  const Mesh mesh = soup.to_mesh(kCrease_deg);
  EXPECT_NEAR(tests::area_m2(mesh), 2.0 * kPi * 0.5 * 2.0, 0.01);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 radial(mesh.positions[i].x, 0.0F, mesh.positions[i].z);
    EXPECT_GT(glm::dot(mesh.normals[i], radial) / 0.5F, 0.999F) << "the front is outside";
  }
}

TEST(AtriumPieces, SmoothedProfileGoesThroughItsPoints) {
  const Profile profile{{1, 0}, {2, 1}, {1, 2}};
  const Profile curve = smoothed(profile, 3);
  ASSERT_EQ(curve.size(), 9U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(curve[4 * i], profile[i]);
}

TEST(AtriumPieces, ArchPanelHasTheAreaOfAWallWithAnOpening) {
  ArchShape shape;
  shape.segments = 64;
  const Mesh mesh = arch_panel(shape).to_mesh(kCrease_deg);
  const double opening = 0.5 * kPi * 1.4 * 1.4;
  const double wall = 2.0 * (3.6 * 2.2 - opening);
  EXPECT_NEAR(tests::area_m2(mesh), wall + kPi * 1.4 * 0.6, 0.01) << "two faces and the soffit";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 n = mesh.normals[i];
    if (std::abs(n.z) > 0.5F) {
      EXPECT_GT(n.z * mesh.positions[i].z, 0.0F);
      continue;
    }
    const glm::vec2 to_middle(-mesh.positions[i].x, 3.2F - mesh.positions[i].y);
    EXPECT_GT(glm::dot(glm::vec2(n), to_middle), 0.9F) << "soffits look into the opening";
  }
}

TEST(AtriumPieces, VoussoirsAreClosedStones) {
  const Mesh mesh = voussoirs(ArchShape{}, 15, 2).to_mesh(0.01F);
  EXPECT_EQ(mesh.triangles.size(), 15U * (2U * 8U + 4U));
  const double ring = 0.5 * kPi * (1.66 * 1.66 - 1.375 * 1.375) * 0.7;
  EXPECT_NEAR(tests::volume_m3(mesh), ring, 0.15 * ring);
}

TEST(AtriumPieces, GroinVaultSeenFromBelow) {
  const Mesh mesh = groin_vault({1.8F, 1.6F}, 3.2F, 1.8F, 12).to_mesh(5.0F);
  glm::dvec3 sum(0.0);
  for (const glm::uvec3& t : mesh.triangles) sum += tests::area_vector(mesh, t);
  EXPECT_NEAR(sum.y, -3.6 * 3.2, 1e-4) << "projects to its whole rectangle, front below";
  for (const glm::vec3& p : mesh.positions) {
    const float u = std::abs(p.x / 1.8F);
    const float v = std::abs(p.z / 1.6F);
    const float height =
        3.2F + 1.8F * std::sqrt(std::max(0.0F, 1.0F - std::pow(std::min(u, v), 2.0F)));
    EXPECT_NEAR(p.y, height, 2e-3F) << "the higher of the two barrels";
  }
}

TEST(AtriumPieces, ColumnStandsFromFloorToSpringing) {
  const Mesh mesh = column(ColumnShape{}).to_mesh(kCrease_deg);
  float least = 1e9F;
  float greatest = -1e9F;
  for (const glm::vec3& p : mesh.positions) {
    least = std::min(least, p.y);
    greatest = std::max(greatest, p.y);
    EXPECT_LE(std::max(std::abs(p.x), std::abs(p.z)), 0.4001F);
  }
  EXPECT_EQ(least, 0.0F);
  EXPECT_FLOAT_EQ(greatest, 3.2F);
  EXPECT_EQ(tests::turned_normals(mesh), 0);
  EXPECT_GT(tests::volume_m3(mesh), 0.0);
}

TEST(AtriumPieces, ClothHangsFromItsRod) {
  ClothShape shape;
  const Mesh mesh = hanging_cloth(shape).to_mesh(180.0F);
  EXPECT_EQ(mesh.triangles.size(), 2U * 24U * 32U);
  glm::dvec3 sum(0.0);
  for (const glm::uvec3& t : mesh.triangles) sum += tests::area_vector(mesh, t);
  EXPECT_LT(sum.z, -3.0) << "the front is along -z";
  EXPECT_GT(tests::area_m2(mesh), 1.05 * 4.0) << "folds take cloth";
}

}  // namespace
}  // namespace renderers::scene
