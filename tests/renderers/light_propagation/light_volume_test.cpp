#include "renderers/light_propagation/propagation.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/light_propagation/intensity_lobe.h"

namespace renderers::light_propagation {
namespace {

constexpr double kPi = std::numbers::pi;

Grid cube(int cells) { return {glm::ivec3(cells), glm::vec3(0.0F), 1.0F}; }

/// One cell's light in the middle of an empty grid.
LightVolume lamp(int cells, const glm::vec4& lobe) {
  LightVolume volume(cube(cells));
  add_lobe(volume.cells[volume.grid.index(glm::ivec3(cells / 2))], lobe, glm::vec3(1.0F));
  return volume;
}

double flux_after(const LightVolume& volume, int steps, bool has_clamp) {
  return propagate(volume, nullptr, {.steps = steps, .has_clamp = has_clamp}).last.flux().x;
}

TEST(IntensityLobe, ACosineLobeHasTheFluxPi) {
  EXPECT_NEAR(static_cast<double>(flux(cosine_lobe({0, 0, 1}))), kPi, 1e-6);
  // In two bands it is 1/4 + cos / 2.
  const glm::vec3 normal = glm::normalize(glm::vec3(1, -2, 3));
  EXPECT_NEAR(intensity(cosine_lobe(normal), normal), 0.75F, 1e-6F);
  EXPECT_NEAR(intensity(cosine_lobe(normal), -normal), -0.25F, 1e-6F);
}

/// Faces see 4 pi together: an even light keeps its power, and so do lobes, as their linear parts
/// cancel. With the wrong digit of common copies the first is off by 2e-5: the control.
TEST(LightVolume, PropagationKeepsPower) {
  for (const glm::vec4& lobe : {glm::vec4(1, 0, 0, 0), cosine_lobe({0, 0, 1}),
                                cosine_lobe(glm::normalize(glm::vec3(1, 1, 1)))}) {
    const LightVolume volume = lamp(17, lobe);
    const double before = volume.flux().x;
    for (const int steps : {1, 4, 8}) {
      EXPECT_NEAR(flux_after(volume, steps, false) / before, 1.0, 5e-6) << steps;
    }
  }
  EXPECT_NEAR(6.0 * (0.4006696846 + 4.0 * 0.4234313545), 4.0 * kPi, 1e-7);
  EXPECT_GT(std::fabs(6.0 * (0.4006696846 + 4.0 * 0.4234413544) / (4.0 * kPi) - 1.0), 1.5e-5);
}

TEST(LightVolume, AClampMakesLightOnce) {
  const LightVolume axis = lamp(17, cosine_lobe({0, 0, 1}));
  const double before = axis.flux().x;
  EXPECT_NEAR(flux_after(axis, 1, true) / before, 1.138, 1e-3);
  EXPECT_NEAR(flux_after(axis, 6, true) / before, 1.138, 2e-3);
  const LightVolume diagonal = lamp(17, cosine_lobe(glm::normalize(glm::vec3(1, 1, 1))));
  EXPECT_NEAR(flux_after(diagonal, 1, true) / diagonal.flux().x, 1.128, 3e-3);
  EXPECT_NEAR(flux_after(lamp(17, {1, 0, 0, 0}), 4, true) / lamp(17, {1, 0, 0, 0}).flux().x, 1.0,
              5e-6);
}

/// A quarter turn of the light turns the result.
TEST(LightVolume, QuarterTurnsPermuteTheResult) {
  const LightVolume along_x = propagate(lamp(9, cosine_lobe({1, 0, 0})), nullptr, {.steps = 3}).sum;
  const LightVolume along_y = propagate(lamp(9, cosine_lobe({0, 1, 0})), nullptr, {.steps = 3}).sum;
  for (int z = 0; z < 9; ++z) {
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 9; ++x) {
        // x to y, y to -x.
        const glm::vec4 a = channel_of(along_x.cells[along_x.grid.index({x, y, z})], 0);
        const glm::vec4 b = channel_of(along_y.cells[along_y.grid.index({8 - y, x, z})], 0);
        EXPECT_NEAR(a.x, b.x, 1e-6F);
        EXPECT_NEAR(a.y, b.z, 1e-6F);
        EXPECT_NEAR(a.z, -b.y, 1e-6F);
        EXPECT_NEAR(a.w, b.w, 1e-6F);
      }
    }
  }
}

/// What is not in the grid any more went through its faces; light near one side leaves there.
TEST(LightVolume, PowerOnlyLeavesThroughTheBorder) {
  LightVolume volume(cube(9));
  add_lobe(volume.cells[volume.grid.index({8, 4, 4})], cosine_lobe({1, 0, 0}), {1, 0, 0});
  const double before = volume.flux().x;
  // Out of the grid at once: the far and the side faces of the cell beyond, as seen from here.
  const double far = 0.75 * 0.4006696846;
  const double side = (0.25 + 0.5 * 2.0 / std::sqrt(5.0)) * 0.4234313545;
  EXPECT_NEAR(before - flux_after(volume, 1, false), far + 4.0 * side, 1e-5);
}

/// The walls of a closed box send out radiosity 1 once and reflect nothing: they receive 1.
LightVolume light_of_walls(int cells, int steps) {
  LightVolume volume(cube(cells));
  for (int a = 0; a < cells; ++a) {
    for (int b = 0; b < cells; ++b) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const bool is_far : {false, true}) {
          glm::ivec3 cell;
          cell[axis] = is_far ? cells - 1 : 0;
          cell[(axis + 1) % 3] = a;
          cell[(axis + 2) % 3] = b;
          glm::vec3 normal(0.0F);
          normal[axis] = is_far ? -1.0F : 1.0F;
          // Flux 1 W of a cell's face, as a lobe of flux pi by pi.
          add_lobe(volume.cells[volume.grid.index(cell)], cosine_lobe(normal),
                   {1.0F / std::numbers::pi_v<float>, 0, 0});
        }
      }
    }
  }
  return propagate(volume, nullptr, {.steps = steps}).sum;
}

TEST(LightVolume, AClosedBoxIsNearlyAsBrightAsItsWalls) {
  // Steps to settle grow with the square of the cells: a grid of 32 takes some 1300.
  const LightVolume settled = light_of_walls(10, 130);
  const auto at_wall = [](const LightVolume& volume, Lookup lookup) {
    return irradiance(volume, {0, 5, 5}, {1, 0, 0}, lookup).x;
  };
  EXPECT_NEAR(at_wall(settled, Lookup::face_flux), 1.03F, 0.03F);
  EXPECT_LT(at_wall(light_of_walls(10, 4), Lookup::face_flux), 0.6F);
  // Control: the reading that takes intensity from half a cell away is twice too bright.
  EXPECT_GT(at_wall(settled, Lookup::half_cell), 1.7F);
}

/// An opaque sheet across a corridor of cells takes most of what comes against its front.
TEST(LightVolume, ASheetBlocksWhatMeetsItsFront) {
  LightVolume volume(cube(12));
  for (int y = 0; y < 12; ++y) {
    for (int z = 0; z < 12; ++z) {
      add_lobe(volume.cells[volume.grid.index({2, y, z})], cosine_lobe({1, 0, 0}), {1, 0, 0});
    }
  }
  const auto beyond = [&](float facing) {
    BlockingVolume blocking(volume.grid);
    for (int y = 0; y <= 12; ++y) {
      for (int z = 0; z <= 12; ++z) {
        blocking.add({6, static_cast<float>(y), static_cast<float>(z)}, {facing, 0, 0}, 1.0F);
      }
    }
    const LightVolume sum = propagate(volume, &blocking, {.steps = 16}).sum;
    double flux_beyond = 0.0;
    for (int x = 7; x < 12; ++x) {
      flux_beyond += static_cast<double>(flux(channel_of(sum.cells[sum.grid.index({x, 6, 6})], 0)));
    }
    return flux_beyond;
  };
  double open = 0.0;
  const LightVolume sum = propagate(volume, nullptr, {.steps = 16}).sum;
  for (int x = 7; x < 12; ++x) {
    open += static_cast<double>(flux(channel_of(sum.cells[sum.grid.index({x, 6, 6})], 0)));
  }
  EXPECT_LT(beyond(-1.0F), 0.35 * open);
  EXPECT_GT(beyond(1.0F), 0.75 * open);  // its back lets pass
}

TEST(Grid, CoversABoxWithAMargin) {
  scene::Box box;
  box.least = {-1, 0, 2};
  box.greatest = {3, 2, 3};
  const Grid grid = grid_around(box, 10);
  EXPECT_EQ(grid.size, glm::ivec3(10, 6, 4));
  EXPECT_FLOAT_EQ(grid.cell_m, 0.5F);
  EXPECT_EQ(grid.cell_at({-0.99F, 0.01F, 2.01F}), glm::ivec3(1, 1, 1));
  EXPECT_EQ(grid.cell_at({2.99F, 1.99F, 2.99F}), glm::ivec3(8, 4, 2));
  EXPECT_EQ(grid.cell_at({99, -99, 2.5F}), glm::ivec3(9, 0, 2));
}

}  // namespace
}  // namespace renderers::light_propagation
