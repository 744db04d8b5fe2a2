#include "metrics/contrast_kept.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

/// 64 x 64 pixels of light 0.8 with a dark square of the given side in the middle.
Image with_shadow(float bottom, int side_px = 16, float surround = 0.8F) {
  const int first = 32 - side_px / 2;
  return picture(64, 64, Encoding::scene_linear, [=](int x, int y) -> std::array<float, 3> {
    const bool is_dark = x >= first && x < first + side_px && y >= first && y < first + side_px;
    const float value = is_dark ? bottom : surround;
    return {value, value, value};
  });
}

double kept(const Image& reference, const Image& test, const char* parameters = "") {
  return detail(score_of(std::string("contrast-kept") + parameters, reference, test), "kept");
}

TEST(ContrastKept, IsTheRatioOfTheDips) {
  const Image reference = with_shadow(0.2F);
  const auto score = score_of("contrast-kept", reference, with_shadow(0.5F));
  EXPECT_NEAR(detail(score, "kept"), 0.3 / 0.6, 1e-6);
  EXPECT_NEAR(score.value, 0.5, 1e-6);
  EXPECT_NEAR(detail(score, "dip"), 0.3, 1e-6);
  EXPECT_NEAR(detail(score, "surround"), 0.8, 1e-6);
  EXPECT_NEAR(detail(score, "reference_dip"), 0.6, 1e-6);
  EXPECT_NEAR(detail(score, "reference_surround"), 0.8, 1e-6);
  EXPECT_NEAR(score.map->at(32, 32), 0.3 / 0.6, 1e-6);
  EXPECT_EQ(score.map->at(2, 2), 0.0F);
}

TEST(ContrastKept, ALostShadowIsOneAndADeeperOneIsNoBetter) {
  const Image reference = with_shadow(0.4F);
  EXPECT_NEAR(score_of("contrast-kept", reference, with_shadow(0.8F)).value, 1.0, 1e-6);
  EXPECT_NEAR(score_of("contrast-kept", reference, with_shadow(0.0F)).value, 1.0, 1e-6);
  EXPECT_NEAR(kept(reference, with_shadow(0.0F)), 2.0, 1e-6);
}

TEST(ContrastKept, LooksAtTheRegionAlone) {
  const Image reference = with_shadow(0.2F);
  Image test = with_shadow(0.5F);
  for (int y = 0; y < 64; ++y) {
    for (float& value : test.pixel(0, y)) value = 0.0F;
  }
  EXPECT_NEAR(kept(reference, test, ",bottom=0"), 0.8 / 0.6, 1e-6);
  EXPECT_NEAR(kept(reference, test, ",bottom=0,x=0.25,width=0.5,y=0.25,height=0.5"), 0.5, 1e-6);
  const Image right = mask_where(64, 64, [](int x, int) { return x > 0; });
  EXPECT_NEAR(detail(score_of("contrast-kept,bottom=0", reference, test, &right), "kept"), 0.5,
              1e-6);
}

TEST(ContrastKept, AShadowMustFillMoreThanTheBottomsShare) {
  // 4 x 4 of 64 x 64 pixels are 0.4 %.
  const Image reference = with_shadow(0.2F, 4);
  const Image test = with_shadow(0.5F, 4);
  EXPECT_TRUE(std::isnan(score_of("contrast-kept", reference, test).value));
  EXPECT_NEAR(kept(reference, test, ",bottom=0.002"), 0.5, 1e-6);
  EXPECT_NEAR(kept(reference, test, ",x=0.375,width=0.25,y=0.375,height=0.25"), 0.5, 1e-6);
}

TEST(ContrastKept, SpecksAreNoSurround) {
  const Image reference = with_shadow(0.2F);
  Image test = reference;
  for (int x = 0; x < 64; ++x) {
    for (float& value : test.pixel(x, 3)) value = 50.0F;
  }
  EXPECT_NEAR(kept(reference, test), 1.0, 1e-6);
  EXPECT_GT(kept(reference, test, ",surround=1"), 50.0);
}

TEST(ContrastKept, WithoutADipThereIsNoValue) {
  const Image flat = gray_picture(64, 64, Encoding::scene_linear, 0.8F);
  const auto score = score_of("contrast-kept", flat, with_shadow(0.2F));
  EXPECT_TRUE(std::isnan(score.value));
  EXPECT_EQ(detail(score, "reference_dip"), 0.0);
  EXPECT_NEAR(detail(score, "dip"), 0.6, 1e-6);
  EXPECT_EQ(score.non_finite_pixels, 0U);
  for (const float value : score.map->pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_TRUE(std::isnan(score_of("contrast-kept", with_shadow(0.7921F), flat).value));
  EXPECT_FALSE(std::isnan(score_of("contrast-kept", with_shadow(0.7919F), flat).value));
}

TEST(ContrastKept, RefusesABottomAboveTheSurround) {
  EXPECT_EQ(input_error_of(
                [] { metrics::parse_metric_choice("contrast-kept,bottom=0.5,surround=0.5", {}); }),
            "metric \"contrast-kept\": bottom is 0.5 and surround 0.5; accepted: bottom below "
            "surround");
}

}  // namespace
