#include "renderers/shadow_maps/scene_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/renderers/scene_builder.h"

namespace renderers::shadow_maps {
namespace {

using test::lambert;
using test::SceneBuilder;

/// A 3 x 1 floor at y = 0 and a 1 x 1 wall at x = 5: four square metres.
scene::Scene two_quads() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {3, 0, 0}, white);
  builder.add_quad({5, 0, 0}, {0, 1, 0}, {0, 0, 1}, white);
  return builder.scene;
}

TEST(ScenePoints, LieOnTheSurfaces) {
  for (const ScenePoint& point : scene_points(two_quads(), 8, 16)) {
    const bool is_on_floor = point.position.y == 0.0F && point.normal == glm::vec4(0, 1, 0, 0);
    const bool is_on_wall = point.position.x == 5.0F && point.normal == glm::vec4(1, 0, 0, 0);
    EXPECT_NE(is_on_floor, is_on_wall);
    // The discs of a set have the scene's area.
    EXPECT_NEAR(16.0 * std::numbers::pi * std::pow(point.position.w, 2.0), 4.0, 1e-5);
  }
}

TEST(ScenePoints, EverySetIsStratifiedByArea) {
  const auto points = scene_points(two_quads(), 13, 40);
  ASSERT_EQ(points.size(), 13U * 40U);
  for (std::size_t set = 0; set < 13; ++set) {
    int on_floor = 0;
    for (std::size_t k = 0; k < 40; ++k)
      on_floor += points[set * 40 + k].position.y == 0.0F ? 1 : 0;
    EXPECT_NEAR(on_floor, 30, 1) << set;  // three quarters of 40
  }
}

TEST(ScenePoints, AreSpreadWithinATriangle) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, white);
  // Contiguous and power-of-two counts alike: all of 64 cells are met by 8 points each on average.
  for (const auto& [sets, per_set] : {std::pair{1, 512}, std::pair{512, 1}, std::pair{32, 16}}) {
    std::vector<int> cells(64, 0);
    for (const ScenePoint& point : scene_points(builder.scene, sets, per_set)) {
      const int x = static_cast<int>(point.position.x * 8.0F);
      const int z = static_cast<int>(point.position.z * 8.0F);
      ++cells[static_cast<std::size_t>(z * 8 + x)];
    }
    for (const int count : cells) EXPECT_GT(count, 0) << sets;
    for (const int count : cells) EXPECT_LT(count, 18) << sets;
  }
}

TEST(ScenePoints, SetsDiffer) {
  std::set<std::tuple<float, float, float>> positions;
  const auto points = scene_points(two_quads(), 64, 16);
  for (const ScenePoint& point : points) {
    positions.insert({point.position.x, point.position.y, point.position.z});
  }
  EXPECT_EQ(positions.size(), points.size());
}

TEST(ScenePoints, MoveWithTheScene) {
  scene::Scene moved = two_quads();
  for (scene::Object& object : moved.objects) object.to_world[3] = glm::vec4(0, 7, 0, 1);
  const auto before = scene_points(two_quads(), 4, 32);
  const auto after = scene_points(moved, 4, 32);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT(glm::length(after[i].position - before[i].position - glm::vec4(0, 7, 0, 0)), 1e-5F);
  }
}

TEST(DealtPoints, KeepTheirPlaceOnTrianglesThatDeform) {
  const scene::Scene before = two_quads();
  scene::Scene after = before;
  // The floor becomes three times as long, so that points dealt anew would move to it.
  after.objects[0].to_world[0] = glm::vec4(3, 0, 0, 0);
  after.objects[1].to_world[3] = glm::vec4(0, 0, 2, 1);
  DealtPoints points(before, 4, 32);
  const std::vector<ScenePoint> dealt = points.points();
  ASSERT_EQ(dealt.size(), scene_points(before, 4, 32).size());
  EXPECT_EQ(points.move(after), 0U);
  int on_floor = 0;
  for (std::size_t i = 0; i < dealt.size(); ++i) {
    const bool is_floor = dealt[i].normal.y > 0.5F;
    on_floor += is_floor ? 1 : 0;
    const glm::vec4 expected =
        dealt[i].position * (is_floor ? glm::vec4(3, 1, 1, 1) : glm::vec4(1)) +
        (is_floor ? glm::vec4(0) : glm::vec4(0, 0, 2, 0));
    EXPECT_LT(glm::length(points.points()[i].position - expected), 1e-5F) << i;
    EXPECT_LT(glm::length(points.points()[i].normal - dealt[i].normal), 1e-6F) << i;
  }
  EXPECT_EQ(on_floor, 96) << "three quarters of the area when they were dealt";
  EXPECT_EQ(points.move(before), 0U);
  for (std::size_t i = 0; i < dealt.size(); ++i) {
    EXPECT_LT(glm::length(points.points()[i].position - dealt[i].position), 1e-5F) << i;
  }
}

TEST(DealtPoints, StayBehindWhereTrianglesChangeOrGo) {
  const scene::Scene before = two_quads();
  scene::Scene after = before;
  for (scene::Object& object : after.objects) object.to_world[3] = glm::vec4(0, 7, 0, 1);
  auto mesh = std::make_shared<scene::Mesh>(*after.objects[1].mesh);
  std::swap(mesh->triangles[0], mesh->triangles[1]);
  after.objects[1].mesh = mesh;
  DealtPoints points(before, 4, 32);
  const std::vector<ScenePoint> dealt = points.points();
  EXPECT_EQ(points.move(after), 32U);
  for (std::size_t i = 0; i < dealt.size(); ++i) {
    const float moved_m = dealt[i].normal.y > 0.5F ? 7.0F : 0.0F;
    EXPECT_NEAR(points.points()[i].position.y, dealt[i].position.y + moved_m, 1e-5F) << i;
  }
  EXPECT_EQ(points.move({}), 128U);
  EXPECT_EQ(DealtPoints({}, 4, 32).move(after), 0U);
}

TEST(ScenePoints, NoneWithoutArea) {
  EXPECT_TRUE(scene_points({}, 4, 4).empty());
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {0, 0, 2}, white);
  EXPECT_TRUE(scene_points(builder.scene, 4, 4).empty());
}

TEST(SurfacePoints, LieOnTheirTrianglesAndStandForEqualAreas) {
  // A triangle without area before all others must not shift the numbers.
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({9, 0, 0}, {0, 0, 1}, {0, 0, 2}, white);
  builder.scene.objects.push_back(two_quads().objects[0]);
  builder.scene.objects.push_back(two_quads().objects[1]);
  for (int set = 0; set < 3; ++set) {
    const SurfacePoints made = surface_points(builder.scene, set, 80);
    EXPECT_DOUBLE_EQ(made.area_m2, 4.0);
    ASSERT_EQ(made.points.size(), 80U);
    std::vector<int> counts(6, 0);
    for (const SurfacePoint& point : made.points) {
      ++counts.at(static_cast<std::size_t>(point.triangle));
      const bool is_on_floor = point.triangle == 2 || point.triangle == 3;
      EXPECT_EQ(is_on_floor ? point.position.y : point.position.x, is_on_floor ? 0.0F : 5.0F);
      // The floor's triangles lie on two sides of its diagonal.
      const float beyond = point.position.x - 3.0F * point.position.z;
      if (is_on_floor) {
        EXPECT_LE(point.triangle == 2 ? beyond : -beyond, 1e-5F);
      }
    }
    EXPECT_EQ(counts, (std::vector<int>{0, 0, 30, 30, 10, 10})) << set;
  }
}

TEST(SurfacePoints, PrefixesAndRunsOfTheirPlacesAreSpread) {
  for (const int count : {64, 100}) {
    const SurfacePoints made = surface_points(two_quads(), 0, count);
    std::vector<std::size_t> piece_at(made.points.size(), made.points.size());
    for (std::size_t i = 0; i < made.points.size(); ++i) {
      piece_at.at(static_cast<std::size_t>(made.points[i].place)) = i;
    }
    // Every place is taken once; four neighbours have one point near each quarter of the list.
    for (std::size_t first = 0; first < made.points.size(); first += 4) {
      std::vector<std::size_t> run(piece_at.begin() + static_cast<std::ptrdiff_t>(first),
                                   piece_at.begin() + static_cast<std::ptrdiff_t>(first) + 4);
      std::ranges::sort(run);
      for (std::size_t k = 1; k < 4; ++k) {
        EXPECT_GE(run[k] - run[k - 1], made.points.size() / 8) << count;
      }
      EXPECT_LT(run[3], made.points.size());
    }
  }
}

TEST(SurfacePoints, SetsDifferAndDegenerateScenesHaveNone) {
  const SurfacePoints a = surface_points(two_quads(), 0, 50);
  const SurfacePoints b = surface_points(two_quads(), 1, 50);
  for (const SurfacePoint& one : a.points) {
    for (const SurfacePoint& other : b.points) EXPECT_NE(one.position, other.position);
  }
  EXPECT_TRUE(surface_points({}, 0, 4).points.empty());
  EXPECT_EQ(surface_points({}, 0, 4).area_m2, 0.0);
}

}  // namespace
}  // namespace renderers::shadow_maps
