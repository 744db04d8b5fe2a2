#include "metrics/visible_regions.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "perception/image.h"

namespace {

using metrics::visible_regions;
using perception::Image;

/// Digits are values, dots are 0.
Image drawn(const std::vector<std::string>& rows) {
  Image map =
      perception::make_gray_image(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()),
                                  "jnd", perception::Encoding::scene_linear);
  for (int y = 0; y < map.height_px; ++y) {
    for (int x = 0; x < map.width_px; ++x) {
      const char mark = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
      map.at(x, y) = mark == '.' ? 0.0F : static_cast<float>(mark - '0');
    }
  }
  return map;
}

void expect_region(const metrics::Region& region, int x, int y, int width, int height,
                   double value) {
  EXPECT_EQ(region.x_px, x);
  EXPECT_EQ(region.y_px, y);
  EXPECT_EQ(region.width_px, width);
  EXPECT_EQ(region.height_px, height);
  EXPECT_EQ(region.value, value);
}

TEST(VisibleRegions, AreListedByTheirPixels) {
  const auto found = visible_regions(drawn({"2....33",  //
                                            ".1...3.",  //
                                            ".....9.",  //
                                            "5......"}),
                                     nullptr, 1.0F, 10);
  ASSERT_EQ(found.count, 3U);
  EXPECT_EQ(found.most_pixels, 4U);
  expect_region(found.largest[0], 5, 0, 2, 3, 9.0);
  expect_region(found.largest[1], 0, 0, 1, 1, 2.0);
  expect_region(found.largest[2], 0, 3, 1, 1, 5.0);
}

TEST(VisibleRegions, CornersTouchAndArmsMeetLate) {
  const auto corner = visible_regions(drawn({"2..", ".2.", "..2"}), nullptr, 1.0F, 10);
  ASSERT_EQ(corner.count, 1U);
  expect_region(corner.largest[0], 0, 0, 3, 3, 2.0);
  // Three arms that only the last row joins, and a diagonal the other way.
  const auto comb = visible_regions(drawn({"2.2.2", "2.2.2", "22222"}), nullptr, 1.0F, 10);
  ASSERT_EQ(comb.count, 1U);
  EXPECT_EQ(comb.most_pixels, 11U);
  EXPECT_EQ(visible_regions(drawn({"..2", ".2.", "2.."}), nullptr, 1.0F, 10).count, 1U);
  EXPECT_EQ(visible_regions(drawn({"2.2", "...", "2.2"}), nullptr, 1.0F, 10).count, 4U);
}

TEST(VisibleRegions, LimitMaskAndLength) {
  const Image map = drawn({"212", "...", "3.4"});
  EXPECT_EQ(visible_regions(map, nullptr, 1.0F, 10).count, 4U);
  EXPECT_EQ(visible_regions(map, nullptr, 1.0F, 2).largest.size(), 2U);
  EXPECT_EQ(visible_regions(map, nullptr, 9.0F, 10).count, 0U);
  const Image mask = drawn({"000", "000", "001"});
  const auto masked = visible_regions(map, &mask, 1.0F, 10);
  ASSERT_EQ(masked.count, 1U);
  expect_region(masked.largest[0], 2, 2, 1, 1, 4.0);
}

}  // namespace
