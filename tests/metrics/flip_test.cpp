#include "metrics/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "perception/color_conversion.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

using Color = std::array<float, 3>;
using Pattern = std::function<Color(int x, int y)>;

constexpr int kSidePx = 64;
/// Six published digits, and the rounding of single precision in the authors' program.
constexpr double kTolerance = 2e-6;

Pattern uniform(float r, float g, float b) {
  return [=](int, int) { return Color{r, g, b}; };
}
Pattern gray(float value) { return uniform(value, value, value); }
Pattern step_at(int edge_px) {
  return [=](int x, int) {
    return x < edge_px ? Color{0.2F, 0.2F, 0.2F} : Color{0.8F, 0.8F, 0.8F};
  };
}
Pattern one_white_pixel() {
  return [](int x, int y) {
    return x == 32 && y == 32 ? Color{1.0F, 1.0F, 1.0F} : Color{0.5F, 0.5F, 0.5F};
  };
}
Pattern checker() {
  return [](int x, int y) {
    return (x + y) % 2 == 1 ? Color{0.8F, 0.8F, 0.8F} : Color{0.2F, 0.2F, 0.2F};
  };
}
Pattern ramp(float factor) {
  return [=](int x, int) {
    const float value = factor * std::exp2(static_cast<float>(x - 32) / 8.0F);
    return Color{value, value, value};
  };
}

/// FLIP of two patterns of linear values at the resolution of the published results.
metrics::Score flip_of(const Pattern& reference, const Pattern& test, const std::string& options) {
  return score_of("flip,ppd=67.020645," + options,
                  picture(kSidePx, kSidePx, Encoding::scene_linear, reference),
                  picture(kSidePx, kSidePx, Encoding::scene_linear, test));
}

/// Results of the authors' program, version 1.6, for pictures of 64 x 64 pixels. Its interface
/// takes linear values, so the numbers below are linear; read as sRGB they give other results.
struct PublishedLdr {
  const char* name;
  Pattern reference;
  Pattern test;
  double mean;
};

std::vector<PublishedLdr> published_ldr() {
  return {
      {"black, white", gray(0.0F), gray(1.0F), 0.967388},
      {"green, blue", uniform(0, 1, 0), uniform(0, 0, 1), 1.000000},
      {"red, green", uniform(1, 0, 0), uniform(0, 1, 0), 0.986665},
      {"dark, light grey", gray(0.1F), gray(0.9F), 0.951376},
      {"grey, reddish", gray(0.5F), uniform(0.51F, 0.5F, 0.5F), 0.040317},
      {"grey, warm", gray(0.18F), uniform(0.19F, 0.18F, 0.17F), 0.067339},
      {"black, grey", gray(0.0F), gray(0.5F), 0.958551},
      {"moved step", step_at(32), step_at(33), 0.028312},
      {"one white pixel", gray(0.5F), one_white_pixel(), 0.000543},
      {"checker", gray(0.5F), checker(), 0.002730},
  };
}

TEST(Flip, ReproducesTheAuthorsProgramOnLinearValues) {
  for (const PublishedLdr& published : published_ldr()) {
    const auto score = flip_of(published.reference, published.test, "mode=ldr");
    EXPECT_NEAR(score.value, published.mean, kTolerance) << published.name;
  }
}

TEST(Flip, ReadingTheValuesAsSrgbGivesOtherResults) {
  const Image reference = gray_picture(kSidePx, kSidePx, Encoding::display, 0.1F);
  const Image test = gray_picture(kSidePx, kSidePx, Encoding::display, 0.9F);
  EXPECT_GT(std::abs(score_of("flip,ppd=67.020645", reference, test).value - 0.951376), 0.005);
}

TEST(Flip, ReproducesThePublishedExtremes) {
  const auto step = flip_of(step_at(32), step_at(33), "mode=ldr");
  EXPECT_NEAR(detail(step, "maximum"), 0.474634, kTolerance);
  EXPECT_EQ(detail(step, "maximum_x_px"), 31.0);
  const auto pixel = flip_of(gray(0.5F), one_white_pixel(), "mode=ldr");
  EXPECT_NEAR(detail(pixel, "maximum"), 0.210963, kTolerance);
  EXPECT_EQ(detail(pixel, "maximum_x_px"), 32.0);
  EXPECT_EQ(detail(pixel, "maximum_y_px"), 32.0);
  EXPECT_NEAR(flip_of(gray(0.5F), checker(), "mode=ldr").map->at(0, 0), 0.349711, kTolerance);
}

TEST(Flip, ReproducesTheAuthorsProgramOnAnHdrRamp) {
  const auto score = flip_of(ramp(1.0F), ramp(1.1F), "mode=auto");
  EXPECT_NEAR(score.value, 0.121643, kTolerance);
  EXPECT_NEAR(detail(score, "maximum"), 0.140153, kTolerance);
  EXPECT_NEAR(detail(score, "start_exposure"), -2.79170, 1e-5);
  EXPECT_NEAR(detail(score, "stop_exposure"), 1.08330, 1e-5);
  EXPECT_EQ(detail(score, "exposures"), 4.0);
  EXPECT_EQ(detail(score, "exposure_fallback"), 0.0);
}

TEST(Flip, ReproducesOpenImageIoOnHdrGreys) {
  // Published with four digits.
  const auto score = flip_of(gray(0.1F), gray(0.9F), "mode=auto");
  EXPECT_NEAR(score.value, 0.2045, 5e-5);
  EXPECT_NEAR(detail(score, "start_exposure"), 4.41, 5e-3);
  EXPECT_NEAR(detail(score, "stop_exposure"), 4.41, 5e-3);
  EXPECT_EQ(detail(score, "exposures"), 2.0);
}

TEST(Flip, DisplayPairsAreDecodedAndComparedAsLdr) {
  const Image reference = wavy_picture(40, 30, Encoding::display);
  const Image test = with_noise(reference, 0.1F);
  const auto display = score_of("flip", reference, test);
  EXPECT_EQ(detail(display, "is_hdr"), 0.0);
  const auto linear = score_of("flip,mode=ldr", perception::srgb_decoded(reference),
                               perception::srgb_decoded(test));
  EXPECT_NEAR(display.value, linear.value, 2e-6);
}

TEST(Flip, OneLinearImageMakesThePairHdr) {
  const Image display = wavy_picture(20, 20, Encoding::display);
  const Image linear = perception::srgb_decoded(display);
  const auto score = score_of("flip", linear, display);
  EXPECT_EQ(detail(score, "is_hdr"), 1.0);
  EXPECT_EQ(score.value, 0.0);
}

TEST(Flip, LdrOfLinearImagesUsesTheExposure) {
  perception::ViewingConditions viewing;
  viewing.exposure_ev = 1.0;
  const auto ldr = metrics::parse_metric_choice("flip,mode=ldr", {});
  const Image dim = gray_picture(24, 24, Encoding::scene_linear, 0.25F);
  const Image dimmer = gray_picture(24, 24, Encoding::scene_linear, 0.2F);
  const Image half = gray_picture(24, 24, Encoding::scene_linear, 0.5F);
  const Image less = gray_picture(24, 24, Encoding::scene_linear, 0.4F);
  EXPECT_NEAR(metrics::score(ldr, {dim, dimmer}, viewing).value,
              score_of("flip,mode=ldr", half, less).value, 1e-6);
}

TEST(Flip, PixelsPerDegreeComeFromTheViewingConditionsUnlessGiven) {
  const Image reference = wavy_picture(40, 40, Encoding::display);
  const Image test = with_noise(reference, 0.2F);
  perception::ViewingConditions viewing;
  viewing.pixels_per_degree = 30.0;
  const auto near =
      metrics::score(metrics::parse_metric_choice("flip", {}), {reference, test}, viewing);
  EXPECT_EQ(detail(near, "pixels_per_degree"), 30.0);
  EXPECT_EQ(near.value, score_of("flip,ppd=30", reference, test).value);
  EXPECT_GT(near.value, score_of("flip,ppd=120", reference, test).value);
}

TEST(Flip, BadResolutionsAreRefused) {
  const Image image = wavy_picture(8, 8, Encoding::display);
  EXPECT_EQ(input_error_of([&] { score_of("flip,ppd=0.5", image, image); }),
            "metric \"flip\": 0.5 pixels per degree; accepted: 5 to 1000, or ppd=0 for those of "
            "the viewing conditions");
}

TEST(Flip, TheMapIsTheLargestOverTheExposures) {
  const auto one = [&](const char* exposure) {
    const std::string text(exposure);
    return flip_of(ramp(1.0F), ramp(1.2F),
                   "start_exposure=" + text + ",stop_exposure=" + text + ",exposures=1");
  };
  const auto low = one("-2");
  const auto high = one("1");
  const auto both =
      flip_of(ramp(1.0F), ramp(1.2F), "start_exposure=-2,stop_exposure=1,exposures=2");
  for (std::size_t i = 0; i < both.map->pixels.size(); ++i) {
    EXPECT_EQ(both.map->pixels[i], std::max(low.map->pixels[i], high.map->pixels[i]));
  }
}

TEST(Flip, AMostlyBlackReferenceIsScoredAndSaysSo) {
  Image reference = gray_picture(16, 16, Encoding::scene_linear, 0.0F);
  for (float& value : reference.pixel(8, 8)) value = 1.0F;
  Image test = reference;
  for (float& value : test.pixel(4, 4)) value = 1.0F;
  const auto score = score_of("flip", reference, test);
  EXPECT_EQ(detail(score, "exposure_fallback"), 1.0);
  EXPECT_GT(score.value, 0.0);
  EXPECT_LE(score.value, 1.0);
}

TEST(Flip, NegativeValuesAreCountedAsBlack) {
  const Image reference = gray_picture(8, 8, Encoding::scene_linear, 1.0F);
  Image test = reference;
  test.at(1, 1, 0) = -5.0F;
  Image black = reference;
  black.at(1, 1, 0) = 0.0F;
  const auto score = score_of("flip", reference, test);
  EXPECT_EQ(detail(score, "negative_values"), 1.0);
  EXPECT_EQ(score.value, score_of("flip", reference, black).value);
}

}  // namespace
