#include "renderers/final_gather/hit_rule.h"

#include <gtest/gtest.h>

#include "tests/renderers/final_gather/grid_fixture.h"

/// Which hits occlude a sender around a vertex.
namespace renderers::test {
namespace {

using final_gather::HitCounter;
using final_gather::HitRule;

/// A floor under a lamp, and what else a test adds.
struct LampAndFloor {
  explicit LampAndFloor(bool has_table) {
    const int white = builder.add_material(lambert(glm::vec3(0.5F)));
    const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
    builder.add_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, white);
    builder.add_quad({-0.2F, 3, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.4F}, lamp);
    if (has_table) builder.add_quad({-2, 1.5F, -2}, {0, 0, 4}, {4, 0, 0}, white);
    rays = std::make_unique<ray_tracing::RayScene>(builder.scene, timer,
                                                   ray_tracing::RayQueries::all_hits);
    to.surface = rays->point_on_triangle(1, 0, {0.3F, 0.3F});
    to.normal = to.surface.geometric_normal;
  }
  bool is_occluded(float height, HitRule rule) const {
    const HitCounter counter(*rays);
    const auto is_near_floor = [](const glm::vec3& place) { return place.y < 0.5F; };
    return counter.is_occluded({0.1F, height, 0.2F}, to, rule, is_near_floor);
  }
  SceneBuilder builder;
  StageTimer timer;
  std::unique_ptr<ray_tracing::RayScene> rays;
  element_hierarchy::SidePoint to;
};

/// Points before and behind a lit sheet stand for the sheet, which is lit (Fig. 2, top left).
TEST(HitRule, ALoneFloorIsLitByEveryRuleButTheNaiveOne) {
  const LampAndFloor scene(false);
  for (const HitRule rule : {HitRule::literal, HitRule::local}) {
    EXPECT_FALSE(scene.is_occluded(0.2F, rule));
    EXPECT_FALSE(scene.is_occluded(-0.2F, rule));
  }
  EXPECT_FALSE(scene.is_occluded(0.2F, HitRule::naive));
  EXPECT_TRUE(scene.is_occluded(-0.2F, HitRule::naive));
}

/// The paper's rule forgives the first sheet anywhere: points over a floor under a table count as
/// lit. The local rule finds the umbra.
TEST(HitRule, UnderATableTheLocalRuleFindsTheShadow) {
  const LampAndFloor scene(true);
  EXPECT_FALSE(scene.is_occluded(0.2F, HitRule::literal));
  EXPECT_TRUE(scene.is_occluded(-0.2F, HitRule::literal));
  EXPECT_TRUE(scene.is_occluded(0.2F, HitRule::local));
  EXPECT_TRUE(scene.is_occluded(-0.2F, HitRule::local));
}

/// From within a closed box one boundary is met, from behind it two: both forgiven (Fig. 2, below).
TEST(HitRule, AClosedBoxHasTwoBoundaries) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  scene::Mesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        {(i & 1U) ? 1.0F : -1.0F, (i & 2U) ? 1.0F : 0.0F, (i & 4U) ? 1.0F : -1.0F});
  }
  constexpr unsigned kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& face : kFaces) {
    for (const unsigned i : {1U, 2U}) mesh.triangles.push_back({face[0], face[i], face[i + 1]});
  }
  scene::Object box;
  box.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
  box.material = white;
  builder.scene.objects.push_back(box);
  builder.add_quad({-0.2F, 3, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.4F}, lamp);
  EXPECT_EQ(final_gather::solid_objects(builder.scene), (std::vector<bool>{true, false}));
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer, ray_tracing::RayQueries::all_hits);
  const HitCounter counter(rays);
  element_hierarchy::SidePoint to;
  to.surface = rays.point_on_triangle(1, 0, {0.3F, 0.3F});
  const auto everywhere = [](const glm::vec3&) { return true; };
  for (const float height : {1.2F, 0.5F, -0.3F}) {
    EXPECT_FALSE(counter.is_occluded({0.1F, height, 0.2F}, to, HitRule::literal, everywhere));
  }
  // Through an edge of two triangles the boundary still counts once.
  EXPECT_FALSE(counter.is_occluded({0.0F, -0.3F, 0.0F}, to, HitRule::literal, everywhere));
  EXPECT_TRUE(counter.is_occluded({0.1F, 0.5F, 0.2F}, to, HitRule::naive, everywhere));
}

}  // namespace
}  // namespace renderers::test
