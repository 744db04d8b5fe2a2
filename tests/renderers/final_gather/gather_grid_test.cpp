#include "renderers/final_gather/gather_grid.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

/// The grid of what is seen, and what lies between its vertices.
namespace renderers::final_gather {
namespace {

scene::Camera oblique_camera() {
  scene::Camera camera;
  camera.position = {1.0F, 2.0F, -3.0F};
  camera.look_at = {0.3F, 0.5F, 2.0F};
  camera.vertical_fov_deg = 50.0F;
  return camera;
}

GatherGrid small_grid(DepthSpacing spacing = DepthSpacing::reciprocal,
                      GridBlending blending = GridBlending::tetrahedra) {
  return {oblique_camera(), 1.5, {6, 4, 5}, {1.0, 9.0}, spacing, blending};
}

GatherGrid world_grid(GridBlending blending = GridBlending::tetrahedra) {
  return {oblique_camera(), {6, 4, 5}, {-1.0, -2.0, 0.5}, {2.0, 1.0, 4.5}, blending};
}

/// Every grid that meets linear fields exactly.
std::vector<GatherGrid> exact_grids() {
  return {small_grid(), small_grid(DepthSpacing::reciprocal, GridBlending::trilinear), world_grid(),
          world_grid(GridBlending::trilinear)};
}

/// Points well inside the grid.
class Points {
 public:
  glm::dvec3 next() {
    return {uniform_(random_) * 6.0, uniform_(random_) * 4.0, uniform_(random_) * 5.0};
  }
  double share() { return uniform_(random_); }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> uniform_{0.001, 0.999};
};

TEST(GatherGrid, GoesThereAndBack) {
  for (const GatherGrid& grid :
       {small_grid(), small_grid(DepthSpacing::logarithmic), world_grid()}) {
    Points points;
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 place = points.next();
      EXPECT_LT(glm::distance(grid.to_grid(grid.to_world(place)), place), 1e-3);
    }
  }
}

TEST(GatherGrid, CornersOfThePictureAreCornersOfTheGrid) {
  const GatherGrid grid = small_grid();
  const scene::Camera camera = oblique_camera();
  const glm::vec3 direction = scene::camera_ray_direction(camera, 300, 200, 50.0F, 150.0F);
  const glm::dvec3 place = grid.to_grid(camera.position + 4.0F * direction);
  EXPECT_NEAR(place.x, 1.0, 1e-4);
  EXPECT_NEAR(place.y, 3.0, 1e-4);
}

TEST(GatherGrid, SizeIsAboutWhatWasAskedFor) {
  const GridSize size = grid_size_for(700, 350, 10000);
  EXPECT_NEAR(size.x, 30, 1);
  EXPECT_NEAR(size.y, 15, 1);
  EXPECT_NEAR(static_cast<double>(size.vertex_count()), 11000.0, 1500.0);
}

TEST(GatherGrid, InTheWorldHasCubesAndItsVerticesInItsCorners) {
  const GridSize size = grid_size_for(glm::dvec3(4.0, 2.0, 1.0), 8000);
  EXPECT_EQ(size.x, 40);
  EXPECT_EQ(size.y, 20);
  EXPECT_EQ(size.z, 10);
  // Nearly flat: no axis is without a cell, and none has too many.
  EXPECT_EQ(grid_size_for(glm::dvec3(1.0, 1.0, 1e-9), 1000).z, 1);
  const GatherGrid grid = world_grid();
  EXPECT_LT(glm::distance(grid.vertex(0), {-1.0F, -2.0F, 0.5F}), 1e-5F);
  EXPECT_LT(glm::distance(grid.vertex(grid.vertex_index({6, 4, 5})), {2.0F, 1.0F, 4.5F}), 1e-5F);
  EXPECT_EQ(grid.cell_at({-1.0F, -2.0F, 0.5F}), 0U);
}

/// 2 tan(fov / 2) times the aspect and the depth, in six parts; in the world the same everywhere.
TEST(GatherGrid, CellsAreAsWideAsTheirPartOfThePicture) {
  const double picture_m = 2.0 * std::tan(0.5 * glm::radians(50.0)) * 1.5;
  const GatherGrid grid = small_grid();
  for (const double depth : {1.0, 2.5, 4.9}) {
    const glm::vec3 place = grid.to_world({2.0, 3.0, depth});
    EXPECT_NEAR(grid.cell_width_m(place), picture_m * grid.view_depth_m(place) / 6.0, 1e-5);
    const double apart_m = glm::distance(place, grid.to_world({3.0, 3.0, depth}));
    EXPECT_NEAR(grid.cell_width_m(place), apart_m, 1e-4);
  }
  EXPECT_NEAR(world_grid().cell_width_m({0, 0, 1}), 0.5, 1e-9);
}

TEST(GatherGrid, BlendsLinearFieldsExactly) {
  const auto field = [](const glm::vec3& p) {
    return 0.3 + 1.7 * static_cast<double>(p.x) - 0.6 * static_cast<double>(p.y) +
           0.9 * static_cast<double>(p.z);
  };
  for (const GatherGrid& grid : exact_grids()) {
    Points points;
    for (int i = 0; i < 1000; ++i) {
      const glm::vec3 point = grid.to_world(points.next());
      const GridBlend blend = grid.blend(point);
      double sum = 0.0;
      for (std::size_t c = 0; c < blend.count; ++c) {
        sum += static_cast<double>(blend.weights[c]) * field(grid.vertex(blend.vertices[c]));
      }
      EXPECT_NEAR(sum, field(point), 2e-5);
    }
  }
}

TEST(GatherGrid, TakesFourVerticesOrEight) {
  EXPECT_EQ(small_grid().blend(small_grid().to_world({2.3, 1.2, 3.4})).count, 4U);
  const GatherGrid eight = world_grid(GridBlending::trilinear);
  const GridBlend blend = eight.blend(eight.to_world({2.25, 1.5, 3.0}));
  EXPECT_EQ(blend.used().size(), 8U);
  // Corner 000 of that cell: three quarters, a half, all of the way from the next one.
  EXPECT_NEAR(blend.weights[0], 0.375F, 1e-4F);
}

/// A random value per vertex, blended.
double random_field(const GatherGrid& grid, const glm::vec3& point, bool by_parity) {
  const GridBlend blend = grid.blend(point, by_parity);
  double sum = 0.0;
  for (std::size_t c = 0; c < blend.count; ++c) {
    const double value = std::fabs(std::sin(12.9898 * (blend.vertices[c] + 1.0)) * 43758.5453);
    sum += static_cast<double>(blend.weights[c]) * (value - std::floor(value));
  }
  return sum;
}

/// Largest step over faces between cells.
double largest_step(const GatherGrid& grid, bool by_parity) {
  Points points;
  double largest = 0.0;
  for (int i = 0; i < 6000; ++i) {
    glm::dvec3 place = points.next();
    const int axis = i % 3;
    place[axis] = std::floor(place[axis]) + (place[axis] < 1.0 ? 1.0 : 0.0);
    glm::dvec3 step(0.0);
    step[axis] = 1e-4;
    largest =
        std::max(largest, std::fabs(random_field(grid, grid.to_world(place - step), by_parity) -
                                    random_field(grid, grid.to_world(place + step), by_parity)));
  }
  return largest;
}

TEST(GatherGrid, HasNoStepsBetweenCells) {
  for (const GatherGrid& grid : exact_grids()) EXPECT_LT(largest_step(grid, true), 2e-3);
  // The same cut in every cell tears the field: what this test is to find.
  EXPECT_GT(largest_step(small_grid(), false), 0.3);
}

}  // namespace
}  // namespace renderers::final_gather
