#include "metrics/threshold_ratio.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "perception/threshold_vs_intensity.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

constexpr int kWidth = 128, kHeight = 96;

Image light(double (*light_cd_m2)(int x)) {
  return picture(kWidth, kHeight, Encoding::luminance_cd_m2,
                 [&](int x, int) -> std::array<float, 3> {
                   const auto value = static_cast<float>(light_cd_m2(x));
                   return {value, value, value};
                 });
}

/// Multiplies all light.
Image scaled(Image image, float factor) {
  for (float& value : image.pixels) value *= factor;
  return image;
}

/// A grating of 6 pixels, 11 cpd for the default viewer.
double grating(int x) { return 50.0 * (1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * x / 6.0)); }

Image full_grating() {
  return light([](int x) { return grating(x); });
}

/// The same with its right half flat, of equal mean.
Image half_grating() {
  return light([](int x) { return x < kWidth / 2 ? grating(x) : 50.0; });
}

TEST(ThresholdRatio, IdenticalImagesHaveRatioOne) {
  const auto score = score_of("threshold-ratio", full_grating(), full_grating());
  EXPECT_EQ(score.value, 0.0);
  for (const char* name : {"ratio", "ratio_p05", "ratio_p95"}) {
    EXPECT_EQ(detail(score, name), 1.0) << name;
  }
  EXPECT_EQ(detail(score, "above_double"), 0.0);
  EXPECT_EQ(detail(score, "below_half"), 0.0);
  EXPECT_EQ(detail(score, "threshold_median_cd_m2"),
            detail(score, "reference_threshold_median_cd_m2"));
}

TEST(ThresholdRatio, ScaledLightFollowsTheCurve) {
  // Elevation depends on contrast alone, so that what is left is TVI of the adaptation.
  const auto tvi = [](double light_cd_m2) {
    return perception::threshold_cd_m2(perception::ThresholdCurve::ward, light_cd_m2);
  };
  const Image dim = gray_picture(kWidth, kHeight, Encoding::luminance_cd_m2, 10.0F);
  double last = 1.0;
  for (const float factor : {1.5F, 4.0F, 10.0F}) {
    const double expected = tvi(10.0 * static_cast<double>(factor)) / tvi(10.0);
    const auto score = score_of("threshold-ratio", dim, scaled(dim, factor));
    EXPECT_NEAR(detail(score, "ratio"), expected, 1e-4 * expected) << factor;
    EXPECT_NEAR(score.value, std::log2(expected), 1e-4) << factor;
    EXPECT_GT(detail(score, "ratio"), last);
    last = detail(score, "ratio");

    const double grated = detail(
        score_of("threshold-ratio", full_grating(), scaled(full_grating(), factor)), "ratio");
    const double grated_law = tvi(50.0 * static_cast<double>(factor)) / tvi(50.0);
    EXPECT_NEAR(grated, grated_law, 0.02 * grated_law) << factor;
  }
}

TEST(ThresholdRatio, ExchangeTurnsTheRatioRound) {
  const auto forth = score_of("threshold-ratio", half_grating(), full_grating());
  const auto back = score_of("threshold-ratio", full_grating(), half_grating());
  EXPECT_EQ(forth.value, back.value);
  EXPECT_EQ(detail(forth, "above_double"), detail(back, "below_half"));
  EXPECT_EQ(detail(forth, "below_half"), detail(back, "above_double"));
  EXPECT_NEAR(detail(forth, "ratio_p95") * detail(back, "ratio_p05"), 1.0, 0.02);
}

TEST(ThresholdRatio, ContentThatIsMissingLowersThresholdsThere) {
  const auto score = score_of("threshold-ratio", full_grating(), half_grating());
  EXPECT_LT(score.map->at(100, 48), -0.5F);
  EXPECT_NEAR(score.map->at(16, 48), 0.0F, 0.1F);
  // The region's own pixels alone have a say.
  const auto right = score_of("threshold-ratio,x=0.625,width=0.25", full_grating(), half_grating());
  const auto left = score_of("threshold-ratio,width=0.25", full_grating(), half_grating());
  EXPECT_LT(detail(right, "ratio"), 0.75);
  EXPECT_EQ(detail(right, "above_double"), 0.0);
  EXPECT_NEAR(detail(left, "ratio"), 1.0, 0.05);
  EXPECT_GT(right.value, left.value);
}

TEST(ThresholdRatio, SharesCountWhatIsTwiceAsHigh) {
  // Ten times the light has thresholds more than twice as high; 1.5 times has not.
  const Image dim = gray_picture(kWidth, kHeight, Encoding::luminance_cd_m2, 10.0F);
  const auto brighter = score_of("threshold-ratio", dim, scaled(dim, 10.0F));
  EXPECT_EQ(detail(brighter, "above_double"), 1.0);
  EXPECT_EQ(detail(brighter, "below_half"), 0.0);
  const auto darker = score_of("threshold-ratio", scaled(dim, 10.0F), dim);
  EXPECT_EQ(detail(darker, "above_double"), 0.0);
  EXPECT_EQ(detail(darker, "below_half"), 1.0);
  EXPECT_EQ(detail(score_of("threshold-ratio", dim, scaled(dim, 1.5F)), "above_double"), 0.0);
}

TEST(ThresholdRatio, ProfilesDifferInMaskingNotInLight) {
  const auto ratio_of = [](const char* profile, const Image& reference, const Image& test) {
    return detail(score_of(std::string("threshold-ratio,profile=") + profile, reference, test),
                  "ratio_p05");
  };
  const Image dim = gray_picture(kWidth, kHeight, Encoding::luminance_cd_m2, 10.0F);
  EXPECT_NEAR(ratio_of("rama99", scaled(dim, 10.0F), dim),
              ratio_of("rama99_calibrated", scaled(dim, 10.0F), dim), 1e-5);
  EXPECT_GT(std::abs(ratio_of("rama99", full_grating(), half_grating()) -
                     ratio_of("rama99_calibrated", full_grating(), half_grating())),
            0.01);
}

TEST(ThresholdRatio, RefusesUnknownProfilesAndRegionsBeyondTheImage) {
  const auto parse_error = [](const char* text) {
    return input_error_of([&] { metrics::parse_metric_choice(text, {"suite.yaml", 3, 7}); });
  };
  EXPECT_EQ(
      parse_error("threshold-ratio,profile=rama98"),
      "suite.yaml:3:7: parameter \"profile\" of metric \"threshold-ratio\" cannot be \"rama98\"; "
      "accepted: one of rama99, rama99_calibrated, yee_compat");
  EXPECT_EQ(parse_error("threshold-ratio,x=0.6,width=0.5"),
            "metric \"threshold-ratio\": x + width of the region is 1.1; accepted: at most 1");
}

}  // namespace
