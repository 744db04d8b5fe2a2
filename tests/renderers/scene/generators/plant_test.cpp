#include "renderers/scene/generators/plant.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/generators/mesh_facts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace renderers::scene {
namespace {

std::vector<GeneratedPart> plant_of(const std::string& settings) {
  return generate(base::parse_document("{name: plant" + settings + "}", "p.yaml"));
}

float top_of(const std::vector<GeneratedPart>& parts) {
  float top = 0.0F;
  for (const GeneratedPart& part : parts) {
    for (const glm::vec3& position : part.mesh.positions) top = std::max(top, position.y);
  }
  return top;
}

TEST(Plant, StandsInTheOriginWithLeavesAndStems) {
  const auto parts = plant_of("");
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name, "leaves");
  EXPECT_EQ(parts[1].name, "stems");
  for (const GeneratedPart& part : parts) {
    EXPECT_EQ(tests::turned_normals(part.mesh), 0) << part.name;
    EXPECT_EQ(part.mesh.uvs.size(), part.mesh.positions.size());
  }
  // The first branch starts in the ground, within its own thickness.
  const auto& stems = parts[1].mesh.positions;
  const auto low = std::ranges::min_element(stems, {}, [](const glm::vec3& p) { return p.y; });
  EXPECT_NEAR(low->y, 0.0F, 0.03F);
}

TEST(Plant, IsTheSameForTheSameSettings) {
  const auto a = plant_of(", seed: 7");
  const auto b = plant_of(", seed: 7");
  const auto c = plant_of(", seed: 8");
  EXPECT_EQ(a[0].mesh.positions, b[0].mesh.positions);
  EXPECT_NE(a[0].mesh.positions, c[0].mesh.positions);
}

TEST(Plant, GrowsWithHeightStepsAndSegments) {
  EXPECT_GT(top_of(plant_of(", height: 2")), 1.7F * top_of(plant_of(", height: 1")));
  const std::size_t leaves = plant_of(", steps: 4")[0].mesh.triangles.size();
  EXPECT_GT(plant_of(", steps: 5")[0].mesh.triangles.size(), 2 * leaves);
  EXPECT_EQ(plant_of(", steps: 4, leaf_segments: 8")[0].mesh.triangles.size(), 2 * leaves);
}

TEST(Plant, RefusesWhatItCannotGrow) {
  EXPECT_EQ(::tests::input_error_of([] { plant_of(", height: 0"); }),
            "p.yaml:1:23: height is 0; accepted: above 0");
  EXPECT_EQ(::tests::input_error_of([] { plant_of(", leaf_length: [0.2, 0.1]"); }),
            "p.yaml:1:28: leaf_length is [0.2, 0.1]; accepted: [least, greatest] above 0");
  EXPECT_NE(::tests::input_error_of([] { plant_of(", steps: 8"); }).find("p.yaml:1:22"),
            std::string::npos);
  EXPECT_NE(::tests::input_error_of([] { plant_of(", hight: 1"); }).find("hight"),
            std::string::npos);
}

}  // namespace
}  // namespace renderers::scene
