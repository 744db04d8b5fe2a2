#include "metrics/edge_excess.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

constexpr int kWidth = 128, kHeight = 96;
constexpr double kPixels = kWidth * kHeight;

/// Light that is the same in every column.
template <typename Function>
Image columns(const Function& light_cd_m2) {
  return picture(kWidth, kHeight, Encoding::luminance_cd_m2,
                 [&](int x, int) -> std::array<float, 3> {
                   const float value = light_cd_m2(x);
                   return {value, value, value};
                 });
}

Image gray(float light_cd_m2) {
  return columns([=](int) { return light_cd_m2; });
}

Image with_square(Image image, float added) {
  for (int y = 40; y < 60; ++y) {
    for (int x = 30; x < 50; ++x) {
      for (float& value : image.pixel(x, y)) value += added;
    }
  }
  return image;
}

TEST(EdgeExcess, CountsTheBordersOfASquare) {
  // 20 pixels left of and 20 above the square, 20 at its right and 20 at its lower side, where the
  // corner counts once.
  const Image test = with_square(gray(100.0F), 20.0F);
  const auto score = score_of("edge-excess", gray(100.0F), test);
  EXPECT_EQ(score.value, 79.0 / kPixels);
  EXPECT_EQ(detail(score, "steps"), 79.0 / kPixels);
  EXPECT_EQ(detail(score, "reference_steps"), 0.0);
  EXPECT_EQ(score.value, detail(score_of("visible-difference", gray(100.0F), test), "edge_excess"));
  // Ward's curve sees a large spot of 5.6 % at 100 cd/m2.
  EXPECT_NEAR(score.map->at(29, 50), 20.0 / 5.6, 0.1);
  EXPECT_EQ(score.map->at(35, 50), 0.0F);
  EXPECT_NEAR(detail(score, "threshold_mean_cd_m2"), 5.6, 0.1);
  EXPECT_EQ(detail(score, "largest_step"), score.map->at(29, 50));
}

TEST(EdgeExcess, EdgesOfTheReferenceLostEdgesAndShiftsAreNone) {
  const Image edges = with_square(gray(100.0F), 20.0F);
  EXPECT_EQ(score_of("edge-excess", edges, gray(100.0F)).value, 0.0);
  EXPECT_EQ(score_of("edge-excess", edges, with_square(gray(100.0F), 40.0F)).value, 0.0);
  EXPECT_EQ(score_of("edge-excess", gray(100.0F), gray(150.0F)).value, 0.0);
  EXPECT_EQ(detail(score_of("edge-excess", edges, gray(100.0F)), "reference_steps"),
            79.0 / kPixels);
}

TEST(EdgeExcess, FindsBandsOnASlope) {
  // From 60 to 123.5 cd/m2, in bands of 16 and of 4 columns: 7 steps of 8, or 31 of 2 cd/m2.
  const auto bands = [](int width_px) {
    return columns(
        [=](int x) { return 60.0F + 0.5F * static_cast<float>(x / width_px * width_px); });
  };
  const Image smooth = bands(1);
  EXPECT_EQ(score_of("edge-excess", smooth, bands(16)).value, 7.0 * kHeight / kPixels);
  EXPECT_EQ(score_of("edge-excess", smooth, bands(4)).value, 0.0);
  EXPECT_EQ(score_of("edge-excess,tvi_scale=0.2", smooth, bands(4)).value,
            31.0 * kHeight / kPixels);
  EXPECT_EQ(score_of("edge-excess", smooth, smooth).value, 0.0);
}

TEST(EdgeExcess, ElevationByASlopeHidesItsBands) {
  // Elevation weighs bands of contrast with each other, however faint they are: why it is off.
  const auto bands = [](int width_px) {
    return columns(
        [=](int x) { return 60.0F + 0.5F * static_cast<float>(x / width_px * width_px); });
  };
  const auto threshold_of = [&](const char* masking) {
    return detail(score_of(std::string("edge-excess,masking=") + masking, bands(1), bands(16)),
                  "threshold_mean_cd_m2");
  };
  for (const char* masking : {"joint", "separate"}) {
    EXPECT_GT(threshold_of(masking), 5.0 * threshold_of("off")) << masking;
    EXPECT_EQ(score_of(std::string("edge-excess,masking=") + masking, bands(1), bands(16)).value,
              0.0);
  }
}

TEST(EdgeExcess, LooksAtTheRegionAlone) {
  const Image test = with_square(gray(100.0F), 20.0F);
  // The left side alone: 20 rows in the right half of the left quarter's columns.
  const auto left = score_of("edge-excess,width=0.25,y=0.45,height=0.1", gray(100.0F), test);
  EXPECT_NEAR(left.value, 1.0 / 32.0, 1e-12);
  EXPECT_EQ(score_of("edge-excess,x=0.5,width=0.5", gray(100.0F), test).value, 0.0);
  const Image right = mask_where(kWidth, kHeight, [](int x, int) { return x >= 64; });
  EXPECT_EQ(score_of("edge-excess", gray(100.0F), test, &right).value, 0.0);
}

TEST(EdgeExcess, ThresholdsAreTheReferencesAlone) {
  // A brighter test does not raise them.
  const Image reference = gray(20.0F);
  const Image seam = columns([](int x) { return x < 64 ? 200.0F : 202.0F; });
  EXPECT_EQ(score_of("edge-excess", reference, seam).value, kHeight / kPixels);
  EXPECT_EQ(score_of("edge-excess", gray(200.0F), seam).value, 0.0);
}

}  // namespace
