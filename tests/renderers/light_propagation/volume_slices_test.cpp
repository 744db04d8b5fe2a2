#include "renderers/light_propagation/volume_slices.h"

#include <numbers>

#include <gtest/gtest.h>

#include "renderers/light_propagation/intensity_lobe.h"

namespace renderers::light_propagation {
namespace {

/// A volume of 4 x 3 x 2 cells of 0.5 m of which one is lit, with a flux of 1, 2, 3 W.
LightVolume lit_at(const glm::ivec3& cell) {
  LightVolume volume({glm::ivec3(4, 3, 2), glm::vec3(0.0F), 0.5F});
  add_lobe(volume.cells[volume.grid.index(cell)], cosine_lobe({0, 1, 0}),
           glm::vec3(1, 2, 3) / std::numbers::pi_v<float>);
  return volume;
}

/// Pixels that are lit, each as it should be: from `low` on, `side_px` a side.
void expect_lit(const perception::Image& picture, const glm::ivec2& low, int side_px) {
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const bool is_lit = x >= low.x && x < low.x + side_px && y >= low.y && y < low.y + side_px;
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(picture.at(x, y, c), is_lit ? static_cast<float>(c + 1) / 0.25F : 0.0F, 1e-4F)
            << x << " " << y;
      }
    }
  }
}

TEST(VolumeSlices, ShowACellInItsLayerFromAbove) {
  // Three tiles of 5 x 3 cells side by side, two pixels a cell.
  expect_lit(slice_picture(lit_at({3, 0, 0}), 30, 6), {6, 0}, 2);
  expect_lit(slice_picture(lit_at({3, 1, 1}), 30, 6), {16, 2}, 2);
  expect_lit(slice_picture(lit_at({0, 2, 1}), 33, 7), {20, 2}, 2);
  // Two beside each other, the third below the first.
  expect_lit(slice_picture(lit_at({1, 2, 1}), 10, 6), {1, 4}, 1);
}

TEST(VolumeSlices, TheLowestLayersAreThereWhereNotAllAre) {
  expect_lit(slice_picture(lit_at({2, 0, 1}), 9, 5), {2, 1}, 1);
  expect_lit(slice_picture(lit_at({2, 1, 1}), 10, 5), {7, 1}, 1);
  const perception::Image none = slice_picture(lit_at({2, 2, 1}), 10, 5);
  for (const float value : none.pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_EQ(slice_picture(lit_at({0, 0, 0}), 2, 2).width_px, 2);
}

}  // namespace
}  // namespace renderers::light_propagation
