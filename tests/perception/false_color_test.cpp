#include "perception/false_color.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "perception/color_conversion.h"

namespace perception {
namespace {

float lightness(const std::array<float, 3>& srgb) {
  return lab_from_xyz(
      xyz_from_linear_rgb({srgb_decode(srgb[0]), srgb_decode(srgb[1]), srgb_decode(srgb[2])}))[0];
}

TEST(FalseColor, LightnessRisesEvenly) {
  constexpr int kSteps = 256;
  float before = lightness(false_color(0.0));
  EXPECT_LT(before, 3.0F);
  EXPECT_GT(lightness(false_color(1.0)), 95.0F);
  for (int i = 1; i <= kSteps; ++i) {
    const float now = lightness(false_color(static_cast<double>(i) / kSteps));
    EXPECT_GT(now, before) << "step " << i;
    EXPECT_NEAR(now - before, 96.0F / kSteps, 0.15F) << "step " << i;
    before = now;
  }
}

TEST(FalseColor, StaysInRangeAndClamps) {
  for (int i = 0; i <= 1000; ++i) {
    for (const float value : false_color(i / 1000.0)) {
      EXPECT_GE(value, 0.0F);
      EXPECT_LE(value, 1.0F);
    }
  }
  EXPECT_EQ(false_color(-3.0), false_color(0.0));
  EXPECT_EQ(false_color(3.0), false_color(1.0));
}

TEST(ScalePosition, LinearAndLogarithmic) {
  const MapScale linear{0.0, 2.0, false, ""};
  EXPECT_DOUBLE_EQ(scale_position(0.5, linear), 0.25);
  EXPECT_DOUBLE_EQ(scale_position(-1.0, linear), 0.0);
  EXPECT_DOUBLE_EQ(scale_position(7.0, linear), 1.0);
  const MapScale decades{0.01, 100.0, true, "cd/m2"};
  EXPECT_DOUBLE_EQ(scale_position(1.0, decades), 0.5);
  EXPECT_DOUBLE_EQ(scale_position(0.1, decades), 0.25);
  EXPECT_DOUBLE_EQ(scale_position(0.0, decades), 0.0);
  EXPECT_TRUE(std::isnan(scale_position(std::numeric_limits<double>::quiet_NaN(), decades)));
}

TEST(FalseColorImage, UsesTheScaleNotTheMapsOwnRange) {
  Image map = make_gray_image(2, 1, "Y", Encoding::scene_linear);
  map.pixels = {0.1F, 0.2F};
  const MapScale scale{0.0, 1.0, false, ""};
  const Image both = false_color_image(map, scale);
  const Image left = false_color_image(crop(map, 0, 0, 1, 1), scale);
  EXPECT_EQ(both.encoding, Encoding::display);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(both.at(0, 0, c), left.at(0, 0, c));
}

TEST(FalseColorImage, NonFinitePixelsAreCyan) {
  Image map = make_gray_image(3, 1, "Y", Encoding::scene_linear);
  map.pixels = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                0.0F};
  const Image picture = false_color_image(map, {});
  EXPECT_EQ(std::vector<float>(picture.pixels.begin(), picture.pixels.begin() + 6),
            (std::vector<float>{0, 1, 1, 0, 1, 1}));
  // No colour of the map itself comes near cyan.
  for (int i = 0; i <= 100; ++i) {
    const std::array<float, 3> color = false_color(i / 100.0);
    EXPECT_GT(std::abs(color[0] - 0.0F) + std::abs(color[1] - 1.0F) + std::abs(color[2] - 1.0F),
              0.5F);
  }
}

}  // namespace
}  // namespace perception
