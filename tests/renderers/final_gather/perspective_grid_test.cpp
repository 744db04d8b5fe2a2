#include "renderers/final_gather/perspective_grid.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

/// The perspective grid and its tetrahedra.
namespace renderers::final_gather {
namespace {

scene::Camera oblique_camera() {
  scene::Camera camera;
  camera.position = {1.0F, 2.0F, -3.0F};
  camera.look_at = {0.3F, 0.5F, 2.0F};
  camera.vertical_fov_deg = 50.0F;
  return camera;
}

PerspectiveGrid small_grid(DepthSpacing spacing = DepthSpacing::reciprocal) {
  return {oblique_camera(), 1.5, {6, 4, 5}, {1.0, 9.0}, spacing};
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

TEST(PerspectiveGrid, GoesThereAndBack) {
  for (const DepthSpacing spacing : {DepthSpacing::reciprocal, DepthSpacing::logarithmic}) {
    const PerspectiveGrid grid = small_grid(spacing);
    Points points;
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 place = points.next();
      EXPECT_LT(glm::distance(grid.to_grid(grid.to_world(place)), place), 1e-3);
    }
  }
}

TEST(PerspectiveGrid, CornersOfThePictureAreCornersOfTheGrid) {
  const PerspectiveGrid grid = small_grid();
  const scene::Camera camera = oblique_camera();
  const glm::vec3 direction = scene::camera_ray_direction(camera, 300, 200, 50.0F, 150.0F);
  const glm::dvec3 place = grid.to_grid(camera.position + 4.0F * direction);
  EXPECT_NEAR(place.x, 1.0, 1e-4);
  EXPECT_NEAR(place.y, 3.0, 1e-4);
}

TEST(PerspectiveGrid, SizeIsAboutWhatWasAskedFor) {
  const GridSize size = grid_size_for(700, 350, 10000);
  EXPECT_NEAR(size.x, 30, 1);
  EXPECT_NEAR(size.y, 15, 1);
  EXPECT_NEAR(static_cast<double>(size.vertex_count()), 11000.0, 1500.0);
}

TEST(PerspectiveGrid, BlendsLinearFieldsExactly) {
  const PerspectiveGrid grid = small_grid();
  const auto field = [](const glm::vec3& p) {
    return 0.3 + 1.7 * static_cast<double>(p.x) - 0.6 * static_cast<double>(p.y) +
           0.9 * static_cast<double>(p.z);
  };
  Points points;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 point = grid.to_world(points.next());
    const GridBlend blend = grid.blend(point);
    double sum = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      sum += static_cast<double>(blend.weights[c]) * field(grid.vertex(blend.vertices[c]));
    }
    EXPECT_NEAR(sum, field(point), 2e-5);
  }
}

/// A random value per vertex, blended.
double random_field(const PerspectiveGrid& grid, const glm::vec3& point, bool by_parity) {
  const GridBlend blend = grid.blend(point, by_parity);
  double sum = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    const double value = std::fabs(std::sin(12.9898 * (blend.vertices[c] + 1.0)) * 43758.5453);
    sum += static_cast<double>(blend.weights[c]) * (value - std::floor(value));
  }
  return sum;
}

/// Largest step over faces between cells.
double largest_step(bool by_parity) {
  const PerspectiveGrid grid = small_grid();
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

TEST(PerspectiveGrid, HasNoStepsBetweenCells) {
  EXPECT_LT(largest_step(true), 2e-3);
  // The same cut in every cell tears the field: what this test is to find.
  EXPECT_GT(largest_step(false), 0.3);
}

}  // namespace
}  // namespace renderers::final_gather
