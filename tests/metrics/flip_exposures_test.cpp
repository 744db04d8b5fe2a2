#include "metrics/flip_exposures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::ExposureFallback;
using metrics::ToneMapper;

TEST(FlipExposures, InverseToneCurvesAtTheAnchor) {
  const auto inverse = [](ToneMapper mapper) {
    return metrics::inverse_tone_curve(metrics::tone_curve(mapper), 0.85);
  };
  EXPECT_NEAR(inverse(ToneMapper::aces), 2.1188724, 1e-6);
  EXPECT_NEAR(inverse(ToneMapper::hable), 3.1277493, 1e-6);
  EXPECT_NEAR(inverse(ToneMapper::reinhard), 5.6666667, 1e-6);
}

TEST(FlipExposures, TheAnchorMapsTo085) {
  for (const ToneMapper mapper : {ToneMapper::aces, ToneMapper::hable, ToneMapper::reinhard}) {
    const double anchor = metrics::inverse_tone_curve(metrics::tone_curve(mapper), 0.85);
    const float rgb[3] = {1.0F, 1.0F, 1.0F};
    float red = 0.0F, green = 0.0F, blue = 0.0F;
    metrics::tone_map_row(mapper, std::log2(anchor), rgb, 1, {&red, &green, &blue});
    EXPECT_NEAR(red, 0.85, 1e-6);
    EXPECT_NEAR(blue, 0.85, 1e-6);
  }
}

TEST(FlipExposures, HugeAndNegativeValuesStayOnTheDisplay) {
  for (const ToneMapper mapper : {ToneMapper::aces, ToneMapper::hable, ToneMapper::reinhard}) {
    const float rgb[6] = {3e38F, 1e20F, 1e8F, -1.0F, -3e38F, 0.0F};
    std::vector<float> red(2), green(2), blue(2);
    metrics::tone_map_row(mapper, 10.0, rgb, 2, {red.data(), green.data(), blue.data()});
    EXPECT_GT(red[0], 0.9F);
    EXPECT_LE(red[0], 1.0F);
    EXPECT_EQ(red[1], 0.0F);
    EXPECT_EQ(green[1], 0.0F);
    EXPECT_EQ(blue[1], 0.0F);
  }
}

TEST(FlipExposures, RunFromMaximumToUpperMedianOfTheReference) {
  // Luminances 1, 2, 4, 8: the upper median is 4.
  Image reference = gray_picture(4, 1, Encoding::scene_linear, 1.0F);
  for (int x = 0; x < 4; ++x) {
    for (float& value : reference.pixel(x, 0)) value = std::ldexp(1.0F, x);
  }
  const auto range = metrics::choose_exposures(reference, reference, ToneMapper::aces, {});
  EXPECT_NEAR(range.start_ev, std::log2(2.1188724 / 8.0), 1e-6);
  EXPECT_NEAR(range.stop_ev, std::log2(2.1188724 / 4.0), 1e-6);
  EXPECT_EQ(range.count, 2);
  EXPECT_EQ(range.fallback, ExposureFallback::none);
}

TEST(FlipExposures, AMedianOfZeroFallsBackToWhatIsLit) {
  Image reference = gray_picture(10, 1, Encoding::scene_linear, 0.0F);
  for (float& value : reference.pixel(3, 0)) value = 0.5F;
  for (float& value : reference.pixel(4, 0)) value = 2.0F;
  const auto range = metrics::choose_exposures(reference, reference, ToneMapper::aces, {});
  EXPECT_EQ(range.fallback, ExposureFallback::positive_reference_median);
  EXPECT_NEAR(range.start_ev, std::log2(2.1188724 / 2.0), 1e-6);
  EXPECT_NEAR(range.stop_ev, std::log2(2.1188724 / 2.0), 1e-6);
}

TEST(FlipExposures, ABlackReferenceFallsBackToTheTest) {
  const Image black = gray_picture(5, 5, Encoding::scene_linear, 0.0F);
  const Image lit = gray_picture(5, 5, Encoding::scene_linear, 1.0F);
  const auto range = metrics::choose_exposures(black, lit, ToneMapper::aces, {});
  EXPECT_EQ(range.fallback, ExposureFallback::positive_test_median);
  EXPECT_NEAR(range.start_ev, std::log2(2.1188724), 1e-6);
  const auto none = metrics::choose_exposures(black, black, ToneMapper::aces, {});
  EXPECT_EQ(none.fallback, ExposureFallback::black);
  EXPECT_EQ(none.start_ev, 0.0);
}

TEST(FlipExposures, MaskedPixelsHaveNoSay) {
  // Luminances 1, 2, 4, 8 without the last: the maximum is 4, the upper median 2.
  Image reference = gray_picture(4, 1, Encoding::scene_linear, 1.0F);
  for (int x = 0; x < 4; ++x) {
    for (float& value : reference.pixel(x, 0)) value = std::ldexp(1.0F, x);
  }
  Image mask = perception::make_gray_image(4, 1, "mask", Encoding::scene_linear);
  mask.pixels = {1.0F, 1.0F, 1.0F, 0.0F};
  const auto range = metrics::choose_exposures(reference, reference, ToneMapper::aces, {}, &mask);
  EXPECT_NEAR(range.start_ev, std::log2(2.1188724 / 4.0), 1e-6);
  EXPECT_NEAR(range.stop_ev, std::log2(2.1188724 / 2.0), 1e-6);
  // A lit pixel that takes no part leaves a black picture; the test's is masked alike.
  Image lit = gray_picture(4, 1, Encoding::scene_linear, 0.0F);
  for (float& value : lit.pixel(3, 0)) value = 5.0F;
  const auto black = metrics::choose_exposures(lit, lit, ToneMapper::aces, {}, &mask);
  EXPECT_EQ(black.fallback, ExposureFallback::black);
}

TEST(FlipExposures, TheMetricPassesItsMaskOn) {
  Image reference = gray_picture(8, 8, Encoding::scene_linear, 0.5F);
  for (float& value : reference.pixel(7, 7)) value = 1000.0F;
  Image mask = perception::make_gray_image(8, 8, "mask", Encoding::scene_linear);
  mask.pixels.assign(64, 1.0F);
  mask.at(7, 7) = 0.0F;
  const auto choice = metrics::parse_metric_choice("flip", {});
  const auto start_of = [&](const metrics::ImagePair& pair) {
    const auto score = metrics::score(choice, pair, perception::default_viewing_conditions());
    for (const auto& detail : score.details) {
      if (detail.name == "start_exposure") return detail.value;
    }
    return std::nan("");
  };
  EXPECT_NEAR(start_of({reference, reference}), std::log2(2.1188724 / 1000.0), 1e-6);
  EXPECT_NEAR(start_of({reference, reference, nullptr, &mask}), std::log2(2.1188724 / 0.5), 1e-6);
}

TEST(FlipExposures, FixedOnesAreEquallySpaced) {
  const Image any = gray_picture(2, 2, Encoding::scene_linear, 1.0F);
  const auto range = metrics::choose_exposures(any, any, ToneMapper::aces, {0.0, 2.0, 3});
  EXPECT_EQ(range.count, 3);
  EXPECT_EQ(range.exposure_ev(0), 0.0);
  EXPECT_EQ(range.exposure_ev(1), 1.0);
  EXPECT_EQ(range.exposure_ev(2), 2.0);
  const auto automatic = metrics::choose_exposures(any, any, ToneMapper::aces, {-1.0, 2.5, 0});
  EXPECT_EQ(automatic.count, 4);
}

TEST(FlipExposures, StartAboveStopIsRefused) {
  const Image any = gray_picture(2, 2, Encoding::scene_linear, 1.0F);
  EXPECT_EQ(input_error_of([&] { score_of("flip,start_exposure=2,stop_exposure=1", any, any); }),
            "metric \"flip\": start_exposure 2 is above stop_exposure 1; accepted: a start at or "
            "below the stop");
  EXPECT_EQ(input_error_of([&] { score_of("flip,start_exposure=50", any, any); }),
            "metric \"flip\": start_exposure 50 is above stop_exposure 1.0833 (automatic); "
            "accepted: a start at or below the stop");
}

}  // namespace
