#include "renderers/scene/generators/marching_cubes.h"

#include "tests/renderers/scene/generators/mesh_facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace renderers::scene {
namespace {

/// Values of a function over [-1, 1]^3.
ScalarGrid sampled(int cells, const std::function<float(const glm::vec3&)>& function) {
  ScalarGrid grid;
  grid.origin = glm::vec3(-1.0F);
  grid.step_m = 2.0F / static_cast<float>(cells);
  grid.points = glm::ivec3(cells + 1);
  for (int z = 0; z <= cells; ++z) {
    for (int y = 0; y <= cells; ++y) {
      for (int x = 0; x <= cells; ++x) {
        grid.values.push_back(function(grid.origin + grid.step_m * glm::vec3(x, y, z)));
      }
    }
  }
  return grid;
}

TEST(MarchingCubes, SphereHasItsAreaAndVolume) {
  constexpr double kRadius = 0.7;
  const Mesh mesh =
      marching_cubes(sampled(40, [](const glm::vec3& p) { return 0.7F - glm::length(p); }), 0.0F);
  EXPECT_EQ(tests::open_edges(mesh), 0);
  const double area = 4.0 * std::numbers::pi * kRadius * kRadius;
  EXPECT_NEAR(tests::area_m2(mesh), area, 0.01 * area);
  const double volume = area * kRadius / 3.0;
  EXPECT_NEAR(tests::volume_m3(mesh), volume, 0.01 * volume) << "positive: the front is outside";
}

/// Every grid point at random in or out: all 256 cases, all ambiguous faces.
ScalarGrid random_grid(std::uint64_t seed, double part_inside) {
  std::mt19937_64 engine(seed);
  return sampled(16, [&](const glm::vec3& p) {
    const auto number = static_cast<double>(engine() >> 11U) / 9007199254740992.0;
    const bool is_rim = std::abs(p.x) > 0.99F || std::abs(p.y) > 0.99F || std::abs(p.z) > 0.99F;
    return is_rim ? -1.0F : static_cast<float>(part_inside - number);
  });
}

TEST(MarchingCubes, NoiseIsWatertightToo) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Mesh mesh =
        marching_cubes(random_grid(seed, 0.1 + 0.13 * static_cast<double>(seed)), 0.0F);
    EXPECT_GT(mesh.triangles.size(), 2000U);
    EXPECT_EQ(tests::open_edges(mesh), 0) << "seed " << seed;
    EXPECT_GT(tests::least_relative_height(mesh), 1e-4) << "seed " << seed;
    EXPECT_GT(tests::volume_m3(mesh), 0.0);
  }
}

TEST(MarchingCubes, TheEdgeCountSeesAHole) {
  Mesh mesh = marching_cubes(random_grid(1, 0.5), 0.0F);
  mesh.triangles.pop_back();
  EXPECT_EQ(tests::open_edges(mesh), 3 - 0) << "three edges lost a side";
}

TEST(MarchingCubes, ValuesAtTheLevelGiveNoDegenerateTriangles) {
  const Mesh mesh = marching_cubes(
      sampled(10,
              [](const glm::vec3& p) {
                return 0.6F - std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
              }),
      0.0F);
  EXPECT_EQ(tests::open_edges(mesh), 0);
  EXPECT_GT(tests::least_relative_height(mesh), 1e-3);
}

}  // namespace
}  // namespace renderers::scene
