#include "renderers/shadow_maps/tessellation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include <glm/geometric.hpp>

#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

using shadow_maps::tessellated;
using shadow_maps::TriangleList;

constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

scene::Scene box_scene() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box({-1, -1, -1}, {2, 1, 0.7F}, white, true);
  return builder.scene;
}

double area_of(const TriangleList& list) {
  double area_m2 = 0.0;
  for (const glm::uvec3& t : list.triangles) {
    const glm::dvec3 a(list.vertices[t.x]);
    area_m2 += 0.5 * glm::length(glm::cross(glm::dvec3(list.vertices[t.y]) - a,
                                            glm::dvec3(list.vertices[t.z]) - a));
  }
  return area_m2;
}

TEST(Tessellation, LeavesNoLongEdgeAndTheSameSurface) {
  for (const float longest_m : {1.0F, 0.3F, 0.11F}) {
    const auto list = tessellated(box_scene(), longest_m, kAny);
    ASSERT_TRUE(list);
    float found_m = 0.0F;
    for (const glm::uvec3& t : list->triangles) {
      for (int i = 0; i < 3; ++i) {
        found_m =
            std::max(found_m, glm::distance(list->vertices[t[i]], list->vertices[t[(i + 1) % 3]]));
      }
    }
    EXPECT_LE(found_m, longest_m);
    EXPECT_GT(found_m, 0.49F * longest_m) << "cut more than needed";
    EXPECT_NEAR(area_of(*list), 2.0 * (3.0 * 2.0 + 3.0 * 1.7 + 2.0 * 1.7), 1e-5);
  }
}

/// In a closed surface every edge belongs to two pieces if no vertex lies inside of another's edge.
TEST(Tessellation, PiecesMeetAtTheirVertices) {
  const auto list = tessellated(box_scene(), 0.25F, kAny);
  ASSERT_TRUE(list);
  std::map<std::array<std::array<float, 3>, 2>, int> uses;
  const auto key = [](const glm::vec3& v) { return std::array{v.x, v.y, v.z}; };
  for (const glm::uvec3& t : list->triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto a = key(list->vertices[t[i]]);
      const auto b = key(list->vertices[t[(i + 1) % 3]]);
      ++uses[{std::min(a, b), std::max(a, b)}];
    }
  }
  EXPECT_GT(uses.size(), 500U);
  for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2);
}

TEST(Tessellation, CutsNothingWithoutALimit) {
  const scene::Scene scene = box_scene();
  for (const float longest_m : {0.0F, 100.0F}) {
    const auto list = tessellated(scene, longest_m, kAny);
    ASSERT_TRUE(list);
    EXPECT_EQ(list->triangles.size(), scene.face_count());
  }
  EXPECT_TRUE(tessellated(scene::Scene{}, 0.1F, kAny)->triangles.empty());
}

TEST(Tessellation, GivesUpBeyondTheMost) {
  const std::size_t count = tessellated(box_scene(), 0.3F, kAny)->triangles.size();
  EXPECT_TRUE(tessellated(box_scene(), 0.3F, count));
  EXPECT_FALSE(tessellated(box_scene(), 0.3F, count - 1));
  EXPECT_FALSE(tessellated(box_scene(), 1e-30F, 10000)) << "halves until floats end";
}

TEST(Tessellation, EndsWhereNothingCanBeHalved) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, white);
  builder.add_quad({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, white);
  builder.add_quad({0, 0, 0}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 1, 0}, white);
  EXPECT_TRUE(tessellated(builder.scene, 0.5F, 1000));
  builder.add_quad({0, 0, 0}, {3e38F, 0, 0}, {0, 3e38F, 0}, white);
  EXPECT_FALSE(tessellated(builder.scene, 0.5F, 1000));
}

}  // namespace
}  // namespace renderers::test
