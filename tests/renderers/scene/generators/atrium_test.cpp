#include "renderers/scene/generators/atrium.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/generators/mesh_facts.h"
#include "tests/renderers/scene/scene_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace renderers::scene {
namespace {

std::vector<GeneratedPart> atrium_of(const std::string& settings) {
  const base::Node node = base::parse_document("{name: atrium" + settings + "}", "a.yaml");
  return generate(node);
}

std::size_t triangles_of(const std::vector<GeneratedPart>& parts) {
  std::size_t count = 0;
  for (const GeneratedPart& part : parts) count += part.mesh.triangles.size();
  return count;
}

TEST(Atrium, MeetsTheNumberOfTriangles) {
  EXPECT_NEAR(static_cast<double>(triangles_of(atrium_of(""))), 98000.0, 0.02 * 98000.0);
  for (const double target : {45000.0, 130000.0}) {
    const auto parts = atrium_of(", triangles: " + std::to_string(static_cast<int>(target)));
    EXPECT_NEAR(static_cast<double>(triangles_of(parts)), target, 0.02 * target);
  }
}

TEST(Atrium, FacesSpanFourDecadesAndNoneIsDegenerate) {
  double least = 1e9;
  double greatest = 0.0;
  for (const GeneratedPart& part : atrium_of("")) {
    EXPECT_GT(tests::least_relative_height(part.mesh), 1e-3) << part.name;
    for (const glm::uvec3& t : part.mesh.triangles) {
      const double area = glm::length(tests::area_vector(part.mesh, t));
      least = std::min(least, area);
      greatest = std::max(greatest, area);
    }
  }
  EXPECT_GE(std::log10(greatest / least), 4.0);
}

TEST(Atrium, NormalsAreUnitAndOnTheFront) {
  for (const GeneratedPart& part : atrium_of("")) {
    ASSERT_EQ(part.mesh.normals.size(), part.mesh.positions.size()) << part.name;
    ASSERT_EQ(part.mesh.uvs.size(), part.mesh.positions.size()) << part.name;
    EXPECT_EQ(tests::turned_normals(part.mesh), 0) << part.name;
    for (const glm::vec3& normal : part.mesh.normals) {
      ASSERT_NEAR(glm::length(normal), 1.0F, 1e-5F) << part.name;
    }
  }
}

TEST(Atrium, SameSeedSameBytes) {
  const auto a = atrium_of(", seed: 7, triangles: 50000");
  const auto b = atrium_of(", seed: 7, triangles: 50000");
  const auto c = atrium_of(", seed: 8, triangles: 50000");
  ASSERT_EQ(a.size(), b.size());
  bool is_other = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].mesh.positions, b[i].mesh.positions);
    EXPECT_EQ(a[i].mesh.normals, b[i].mesh.normals);
    EXPECT_EQ(a[i].mesh.triangles, b[i].mesh.triangles);
    is_other = is_other || a[i].mesh.positions != c[i].mesh.positions;
  }
  EXPECT_TRUE(is_other);
}

TEST(Atrium, SizesOutOfRangeAreRefused) {
  EXPECT_EQ(tests::input_error_of([] { atrium_of(", triangles: 100"); }),
            "a.yaml:1:27: triangles 100 is outside [45000, 1000000]");
}

}  // namespace
}  // namespace renderers::scene
