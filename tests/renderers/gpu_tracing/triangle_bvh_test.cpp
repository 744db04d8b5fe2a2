#include "renderers/gpu_tracing/triangle_bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/renderers/gpu_tracing/random_triangles.h"
#include "tests/renderers/scene_builder.h"

/// The hierarchy as it is made on the CPU.
namespace renderers::gpu_tracing {
namespace {

constexpr std::uint32_t kRange = TriangleBvh::kLeafCountRange;

bool holds(const BvhNode& node, const glm::vec3& point) {
  return glm::all(glm::lessThan(node.low, point)) && glm::all(glm::lessThan(point, node.high));
}

/// Laws of the order of nodes, of boxes and leaves; every triangle stands in one leaf.
void expect_lawful(const TriangleBvh& bvh, std::size_t triangles) {
  ASSERT_EQ(bvh.triangles.size(), triangles);
  std::vector<int> seen(triangles, 0);
  for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    ASSERT_GT(node.skip, i);
    ASSERT_LE(node.skip, bvh.nodes.size());
    if (node.leaf != 0) {
      ASSERT_EQ(node.skip, i + 1);
      for (std::uint32_t t = node.leaf / kRange; t < node.leaf / kRange + node.leaf % kRange; ++t) {
        ++seen[t];
        for (const glm::vec3& corner :
             {bvh.triangles[t].a, bvh.triangles[t].b, bvh.triangles[t].c}) {
          EXPECT_TRUE(holds(node, corner)) << i;
        }
      }
      continue;
    }
    // Two children side by side fill an inner node.
    const std::uint32_t second = bvh.nodes[i + 1].skip;
    ASSERT_LT(second, node.skip);
    ASSERT_EQ(bvh.nodes[second].skip, node.skip);
    for (const std::uint32_t child : {i + 1, second}) {
      EXPECT_TRUE(glm::all(glm::lessThanEqual(node.low, bvh.nodes[child].low)));
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(node.high, bvh.nodes[child].high)));
    }
  }
  EXPECT_EQ(std::ranges::count(seen, 1), static_cast<std::ptrdiff_t>(triangles));
}

TEST(TriangleBvh, HoldsEveryTriangleOnceInBoxesAroundThem) {
  for (const std::size_t count : {1U, 2U, 3U, 5U, 64U, 5000U}) {
    expect_lawful(build_bvh(test::random_triangles(count, 0.2F, 7)), count);
  }
}

TEST(TriangleBvh, TrianglesOfOnePlaceDoNotEndTheBuild) {
  std::vector<BvhTriangle> same(3000, test::random_triangles(1, 0.5F, 3).front());
  expect_lawful(build_bvh(same), same.size());
  for (BvhTriangle& triangle : same) triangle.c = triangle.b = triangle.a;
  expect_lawful(build_bvh(same), same.size());
}

TEST(TriangleBvh, WhatIsNotFiniteIsLeftOut) {
  auto triangles = test::random_triangles(20, 0.2F, 5);
  triangles[3].b.y = std::numeric_limits<float>::infinity();
  triangles[11].c.z = std::numeric_limits<float>::quiet_NaN();
  expect_lawful(build_bvh(triangles), 18);
}

TEST(TriangleBvh, OfNothingIsEmpty) {
  EXPECT_TRUE(build_bvh(std::vector<BvhTriangle>{}).nodes.empty());
  const scene::Scene empty;
  StageTimer timer;
  const ray_tracing::RayScene rays(empty, timer);
  EXPECT_TRUE(build_bvh(rays).triangles.empty());
}

/// Names and corners are the scene's, mirrored objects included.
TEST(TriangleBvh, KnowsWhereTrianglesComeFrom) {
  test::SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_sphere({0, 1, 0}, 1.0F, 12, white);
  builder.add_box({1, 0, 0}, {2, 1, 1}, white, false);
  builder.scene.objects[1].to_world[0][0] = -1.0F;
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer);
  const TriangleBvh bvh = build_bvh(rays);
  expect_lawful(bvh, rays.triangle_count());
  std::set<std::pair<std::uint32_t, std::uint32_t>> names;
  for (const BvhTriangle& t : bvh.triangles) {
    names.emplace(t.object, t.triangle);
    const auto& corners = rays.triangle_corners(t.object, t.triangle);
    EXPECT_TRUE(t.a == corners[0] && t.b == corners[1] && t.c == corners[2]);
  }
  EXPECT_EQ(names.size(), rays.triangle_count());
}

}  // namespace
}  // namespace renderers::gpu_tracing
