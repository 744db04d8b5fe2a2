#include "renderers/scene/generators/toy_room.h"

#include "renderers/scene/generators/lindenmayer_plant.h"
#include "renderers/scene/generators/mesh_pieces.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene/generators/mesh_facts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace renderers::scene {
namespace {

std::vector<GeneratedPart> toy_room_of(const std::string& settings) {
  return generate(base::parse_document("{name: toy-room" + settings + "}", "t.yaml"));
}

TEST(Ellipsoid, HasItsVolumeAndLooksOutwards) {
  Mesh mesh;
  add_ellipsoid(mesh, {1, 2, 3}, {0.5F, 1.0F, 2.0F}, 64);
  const double volume_m3 = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_NEAR(tests::volume_m3(mesh), volume_m3, 0.01 * volume_m3);
  EXPECT_EQ(tests::turned_normals(mesh), 0);
}

TEST(Tube, HasTheVolumeOfAFrustum) {
  Mesh mesh;
  add_tube(mesh, {{1, 1, 1}, {1, 1, 3}, 0.5F, 0.25F, 64, true});
  const double volume_m3 = std::numbers::pi * 2.0 / 3.0 * (0.25 + 0.125 + 0.0625);
  EXPECT_NEAR(tests::volume_m3(mesh), volume_m3, 0.01 * volume_m3);
  EXPECT_EQ(tests::turned_normals(mesh), 0);
}

/// A triples at every step; each F becomes S/////F and then FL/////S/////F.
TEST(Bush, GrowsByItsRules) {
  EXPECT_EQ(bush_word(0), "A");
  EXPECT_EQ(bush_word(1), "[&FLA]/////[&FLA]///////[&FLA]");
  const std::string word = bush_word(3);
  EXPECT_EQ(std::ranges::count(word, 'A'), 27);
  // Three of age 2, each two F; nine of age 1, one each; 27 new ones.
  EXPECT_EQ(std::ranges::count(word, 'F'), 3 * 2 + 9 + 27);
  std::mt19937_64 engine(1);
  Mesh stems;
  const auto leaves = grow(word, {0, 0, 0}, 1.0F, engine, stems);
  EXPECT_EQ(static_cast<std::ptrdiff_t>(leaves.size()), std::ranges::count(word, 'L'));
  EXPECT_EQ(static_cast<std::ptrdiff_t>(stems.triangles.size()), 8 * (6 + 9 + 27));
}

TEST(ToyRoom, HasItsTrianglesAndTwoLights) {
  std::size_t triangles = 0;
  int lights = 0;
  for (const GeneratedPart& part : toy_room_of(", triangles: 150000")) {
    triangles += part.mesh.triangles.size();
    ASSERT_EQ(part.mesh.normals.size(), part.mesh.positions.size()) << part.name;
    ASSERT_EQ(part.mesh.uvs.size(), part.mesh.positions.size()) << part.name;
    for (const glm::vec3& normal : part.mesh.normals) {
      ASSERT_NEAR(glm::length(normal), 1.0F, 1e-4F) << part.name;
    }
    if (part.name != "leaves") {
      EXPECT_EQ(tests::turned_normals(part.mesh), 0) << part.name;
    }
    if (part.material.is_emissive()) ++lights;
  }
  EXPECT_NEAR(static_cast<double>(triangles), 150000.0, 150.0);
  EXPECT_EQ(lights, 2);
}

TEST(ToyRoom, RefusesNumbersItCannotMeet) {
  EXPECT_NE(tests::input_error_of([] { toy_room_of(", triangles: 1000"); }), "no error");
}

}  // namespace
}  // namespace renderers::scene
