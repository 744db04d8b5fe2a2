#include "metrics/sequence_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::MetricChoice;
using metrics::SharedChoice;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
/// The scene-linear value that the ACES curve shows as 0.85.
constexpr double kAnchor = 2.1188724;

Image gray(float value) { return gray_picture(8, 8, Encoding::scene_linear, value); }

/// Mostly `median`, one pixel of `maximum`.
Image lit(float median, float maximum) {
  Image image = gray(median);
  for (float& value : image.pixel(0, 0)) value = maximum;
  return image;
}

MetricChoice shared_over(const std::string& metric, const std::vector<Image>& references,
                         const Image* mask = nullptr) {
  SharedChoice shared(metrics::parse_metric_choice(metric, {}));
  for (const Image& reference : references) shared.add(reference, mask);
  return shared.choice();
}

double stops(const MetricChoice& choice, const char* name) {
  return std::stod(choice.parameters.text(name));
}

TEST(SharedChoice, IsOfMetricsThatFollowTheReferenceOnly) {
  const auto follows = [](const char* metric) {
    return SharedChoice(metrics::parse_metric_choice(metric, {})).follows_reference();
  };
  EXPECT_TRUE(follows("flip"));
  EXPECT_TRUE(follows("flip,start_exposure=1"));
  EXPECT_FALSE(follows("flip,start_exposure=1,stop_exposure=2"));
  EXPECT_FALSE(follows("flip,mode=ldr"));
  for (const auto& info : metrics::metric_list()) {
    EXPECT_EQ(follows(info.name.c_str()), info.name == "flip") << info.name;
  }
}

TEST(SharedChoice, ExposuresReachFromTheBrightestPixelToTheDarkestMedian) {
  const MetricChoice choice =
      shared_over("flip,ppd=40", {lit(0.5F, 4.0F), lit(0.25F, 1.0F), lit(1.0F, 8.0F)});
  EXPECT_EQ(choice.text, "flip,ppd=40");
  EXPECT_EQ(choice.parameters.real("ppd"), 40.0);
  EXPECT_NEAR(stops(choice, "start_exposure"), std::log2(kAnchor / 8.0), 1e-4);
  EXPECT_NEAR(stops(choice, "stop_exposure"), std::log2(kAnchor / 0.25), 1e-4);
}

TEST(SharedChoice, WhatTheUserFixedStays) {
  const MetricChoice choice = shared_over("flip,start_exposure=-7.5", {lit(0.5F, 4.0F)});
  EXPECT_EQ(choice.parameters.text("start_exposure"), "-7.5");
  EXPECT_NEAR(stops(choice, "stop_exposure"), std::log2(kAnchor / 0.5), 1e-4);
}

TEST(SharedChoice, BlackMaskedAndNonFinitePixelsHaveNoSay) {
  const MetricChoice plain = shared_over("flip", {lit(0.5F, 4.0F)});
  Image broken = lit(0.5F, 4.0F);
  broken.at(3, 3, 1) = kNan;
  broken.at(4, 4, 1) = std::numeric_limits<float>::infinity();
  Image all_broken = gray(kNan);
  EXPECT_EQ(shared_over("flip", {gray(0.0F), broken, all_broken}).parameters.to_text(),
            plain.parameters.to_text());
  const Image mask = mask_where(8, 8, [](int x, int y) { return x != 0 || y != 0; });
  const MetricChoice masked = shared_over("flip", {lit(0.5F, 4.0F)}, &mask);
  EXPECT_NEAR(stops(masked, "start_exposure"), std::log2(kAnchor / 0.5), 1e-4);
  const MetricChoice black = shared_over("flip", {gray(0.0F)});
  EXPECT_EQ(stops(black, "start_exposure"), 0.0);
  EXPECT_EQ(stops(black, "stop_exposure"), 0.0);
}

TEST(SharedChoice, PairsThatAreComparedWithoutExposuresGetNone) {
  const Image display = gray_picture(8, 8, Encoding::display, 0.5F);
  EXPECT_EQ(shared_over("flip", {display}).parameters.text("start_exposure"), "auto");
  EXPECT_NE(shared_over("flip,mode=hdr", {display}).parameters.text("start_exposure"), "auto");
}

TEST(SharedChoice, MakesScoresOfFramesComparable) {
  const std::vector<Image> references{lit(0.5F, 4.0F), lit(0.05F, 0.4F)};
  const auto exposures_of = [&](const MetricChoice& choice) {
    std::set<std::pair<double, double>> exposures;
    for (const Image& reference : references) {
      const auto score = metrics::score(choice, {reference, with_noise(reference, 0.01F)}, {});
      exposures.emplace(detail(score, "start_exposure"), detail(score, "stop_exposure"));
    }
    return exposures;
  };
  EXPECT_EQ(exposures_of(shared_over("flip", references)).size(), 1U);
  // On their own the frames are judged at exposures of their own.
  EXPECT_EQ(exposures_of(metrics::parse_metric_choice("flip", {})).size(), 2U);
}

std::vector<metrics::Score> flicker_of(const std::vector<Image>& reference,
                                       const std::vector<Image>& test, const Image* mask = nullptr,
                                       const metrics::ScoreOptions& options = {}) {
  return metrics::score_sequence(metrics::parse_sequence_metric_choice("flicker", {}),
                                 {.reference = reference, .test = test, .mask = mask}, {}, options);
}

TEST(ScoreSequence, ANonFinitePixelPoisonsTheFramesThatDependOnIt) {
  const std::vector<Image> reference(4, gray(0.5F));
  std::vector<Image> test = reference;
  test[1].at(3, 4, 1) = kNan;
  const auto scores = flicker_of(reference, test);
  ASSERT_EQ(scores.size(), 3U);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_TRUE(std::isnan(scores[i].value));
    EXPECT_EQ(scores[i].non_finite_pixels, 1U);
    EXPECT_EQ(detail(scores[i], "first_non_finite_x_px"), 3.0);
    EXPECT_EQ(detail(scores[i], "first_non_finite_y_px"), 4.0);
  }
  EXPECT_EQ(scores[2].value, 0.0);
  EXPECT_EQ(scores[2].non_finite_pixels, 0U);
}

TEST(ScoreSequence, IgnoringNonFinitePixelsIsMaskingThem) {
  const std::vector<Image> reference(2, gray(0.5F));
  std::vector<Image> test{gray(0.5F), gray(0.6F)};
  const double whole = flicker_of(reference, test)[0].value;
  ASSERT_GT(whole, 0.0);
  test[0].at(3, 4, 1) = kNan;  // the frame before
  const auto ignored = flicker_of(reference, test, nullptr, {.ignore_non_finite = true});
  EXPECT_NEAR(ignored[0].value, whole, 1e-6 * whole);
  EXPECT_EQ(ignored[0].non_finite_pixels, 1U);
  const Image mask = mask_where(8, 8, [](int x, int y) { return x != 3 || y != 4; });
  const auto masked = flicker_of(reference, test, &mask);
  EXPECT_NEAR(masked[0].value, whole, 1e-6 * whole);
  EXPECT_EQ(masked[0].non_finite_pixels, 0U);
  EXPECT_EQ(detail(masked[0], "non_finite_pixels_outside_mask"), 1.0);
  EXPECT_EQ(input_error_of([&] {
              flicker_of(reference, {gray(kNan), gray(0.5F)}, nullptr, {.ignore_non_finite = true});
            }),
            "no pixel is finite in all images; nothing is left to score");
}

TEST(ScoreSequence, HasNoScoreBeforeTheHistoryIsThereAndNoMapUnlessAsked) {
  EXPECT_TRUE(flicker_of({gray(0.5F)}, {gray(0.5F)}).empty());
  EXPECT_TRUE(flicker_of({}, {}).empty());
  const std::vector<Image> two(2, gray(0.5F));
  EXPECT_TRUE(flicker_of(two, two)[0].map.has_value());
  EXPECT_FALSE(flicker_of(two, two, nullptr, {.with_map = false})[0].map.has_value());
}

TEST(ScoreSequence, RefusesWhatDoesNotAgree) {
  const std::vector<Image> two(2, gray(0.5F));
  EXPECT_EQ(input_error_of([&] { flicker_of(two, {gray(0.5F)}); }),
            "2 reference frames and 1 test frames; accepted: equal numbers");
  EXPECT_EQ(input_error_of([&] {
              flicker_of(two, {gray(0.5F), gray_picture(4, 8, Encoding::scene_linear, 0.5F)});
            }),
            "test frame 1 is 4x8 pixels, the first reference frame 8x8; accepted: one size");
}

TEST(AnyMetric, IsFoundInEitherTable) {
  const auto image = metrics::parse_any_metric_choice("relmse,trim=0.1", {});
  const auto sequence = metrics::parse_any_metric_choice("Flicker,tvi_scale=2", {});
  EXPECT_EQ(description_of(image).scope, metrics::MetricScope::image);
  EXPECT_EQ(description_of(sequence).scope, metrics::MetricScope::sequence);
  EXPECT_EQ(text_of(sequence), "Flicker,tvi_scale=2");
  EXPECT_EQ(parameters_of(sequence).real("tvi_scale"), 2.0);
  EXPECT_EQ(metrics::find_description("flicker"), &description_of(sequence));
  EXPECT_EQ(metrics::find_description("flickr"), nullptr);
  EXPECT_EQ(input_error_of([] {
              metrics::parse_any_metric_choice("flickr", {"suite.yaml", 3, 7});
            }),
            "suite.yaml:3:7: unknown metric \"flickr\"; did you mean \"flicker\"? known: "
            "contrast-kept, cvvdp, daly-vdp, delta-e-2000, edge-excess, flicker, flip, holes, "
            "leak, mae, ms-ssim, mse, penumbra-width, psnr, pu-ms-ssim, pu-psnr, pu-ssim, "
            "relative-rmse, relmse, smape, ssim, threshold-ratio, visible-difference, yee");
}

}  // namespace
