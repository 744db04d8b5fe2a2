#include "perception/tone_mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "perception/display_model.h"
#include "tests/expect_error.h"
#include "tests/perception/luminance_patterns.h"

namespace perception {
namespace {

using tests::light_image;

/// A display of 1 to 100 cd/m2 in a dark room, one degree to four pixels.
ViewingConditions display_1_to_100() {
  ViewingConditions viewing;
  viewing.black_cd_m2 = 1.0;
  viewing.peak_cd_m2 = 100.0;
  viewing.ambient_lux = 0.0;
  viewing.pixels_per_degree = 4.0;
  return viewing;
}

/// A room of 1 to 400 cd/m2 with a window of 10000 and more.
Image window_scene() {
  return light_image(128, 128, [](int x, int y) {
    const double room = std::pow(400.0, (x / 4 + 32 * (y / 4)) / 1023.0);  // by foveal squares
    return x > 90 && y < 40 ? 1e4 * (1.0 + 0.01 * x) : room;
  });
}

void expect_monotone_within(const ToneCurve& curve, const DisplayRange& range) {
  double before = 0.0;
  for (double l = 1e-6; l < 1e7; l *= 1.07) {
    EXPECT_GE(curve(l), before);
    EXPECT_GE(curve(l), range.black_cd_m2 * (1.0 - 1e-9));
    EXPECT_LE(curve(l), range.peak_cd_m2 * (1.0 + 1e-9));
    before = curve(l);
  }
}

TEST(DisplayRange, HoldsTheReflectedRoom) {
  const DisplayRange range = display_range(viewing_preset("standard_4k", {}));
  EXPECT_NEAR(range.black_cd_m2, 0.59789, 5e-6);
  EXPECT_NEAR(range.peak_cd_m2, 200.39789, 5e-5);
}

TEST(ToneCurve, IsStraightInLogLogWithItsSlope) {
  const ToneCurve curve({{1.0, 2.0}, {100.0, 20.0}});
  EXPECT_NEAR(curve(10.0), std::sqrt(40.0), 1e-12);
  EXPECT_EQ(curve(0.0), 2.0);
  EXPECT_EQ(curve(-5.0), 2.0);
  EXPECT_EQ(curve(1e9), 20.0);
  EXPECT_TRUE(std::isnan(curve(std::nan(""))));
  EXPECT_NEAR(curve.slope(10.0), (curve(10.001) - curve(9.999)) / 0.002, 1e-6);
  EXPECT_EQ(curve.slope(0.5), 0.0);
  EXPECT_EQ(curve.slope(200.0), 0.0);
  EXPECT_EQ(ToneCurve({{1.0, 3.0}})(50.0), 3.0);
  EXPECT_THROW(ToneCurve({}), base::InputError);
  EXPECT_THROW(ToneCurve({{1.0, 2.0}, {0.5, 3.0}}), base::InputError);
  EXPECT_THROW(ToneCurve({{1.0, 2.0}, {2.0, 1.0}}), base::InputError);
}

TEST(LinearToneCurve, ScalesAndClips) {
  const ToneCurve curve = linear_tone_curve({1.0, 100.0}, 4.0);
  EXPECT_NEAR(curve(10.0), 40.0, 1e-9);
  EXPECT_NEAR(curve.slope(10.0), 4.0, 1e-9);
  EXPECT_NEAR(curve(1000.0), 100.0, 1e-9);
  EXPECT_NEAR(curve(0.0), 1.0, 1e-9);
}

TEST(HistogramAdjustment, ShowsNoContrastThatTheSceneHidesAndUsesTheDisplay) {
  const ViewingConditions viewing = display_1_to_100();
  const ToneCurve curve = histogram_adjustment(window_scene(), viewing);
  expect_monotone_within(curve, display_range(viewing));
  const std::vector<ToneCurve::Point>& points = curve.points();
  EXPECT_NEAR(points.front().display_cd_m2, 1.0, 1e-9);
  EXPECT_NEAR(points.back().display_cd_m2, 100.0, 1e-9);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double world = std::sqrt(points[i].world_cd_m2 * points[i + 1].world_cd_m2);
    const double allowed = threshold_cd_m2(ThresholdCurve::ward, curve(world)) /
                           threshold_cd_m2(ThresholdCurve::ward, world);
    EXPECT_LE(curve.slope(world), 1.06 * allowed) << world;  // trimmed to within 2.5 %
  }
}

TEST(HistogramAdjustment, SpendsTheDisplayWhereTheSceneHasPixels) {
  const ToneCurve curve = histogram_adjustment(window_scene(), display_1_to_100());
  // Nothing lies between 400 and 10000 cd/m2: more than a decade takes none of the display.
  EXPECT_LT(curve(9000.0) / curve(500.0), 1.05);
  EXPECT_GT(curve(400.0) / curve(1.0), 40.0);
}

TEST(HistogramAdjustment, FewLuminancesFarApartAreCompressedEvenly) {
  const Image light = light_image(64, 64, [](int x, int) { return x < 32 ? 0.1 : 1e4; });
  const ToneCurve curve = histogram_adjustment(light, display_1_to_100());
  EXPECT_NEAR(curve(std::sqrt(1e3)), 10.0, 1e-6);
}

TEST(HistogramAdjustment, ALimitThatIsOffGivesPlainLinearCeilings) {
  HistogramSettings settings;
  settings.limits_contrast = false;
  const ToneCurve curve = histogram_adjustment(window_scene(), display_1_to_100(), settings);
  for (double l = 1.1; l < 1e4; l *= 1.1) {
    // Never more contrast than the scene: exponent at most 1.
    EXPECT_LE(curve.slope(l) * l / curve(l), 1.06) << l;
  }
}

TEST(HistogramAdjustment, ASceneThatFitsIsScaledByOneFactor) {
  const Image light = light_image(64, 64, [](int x, int) { return 20.0 + 0.2 * x; });
  const ToneCurve curve = histogram_adjustment(light, display_1_to_100());
  EXPECT_NEAR(curve(30.0) / curve(20.0), 1.5, 1e-9);
  // Contrast-based: the factor that makes just visible steps just visible.
  double log_sum = 0.0;
  for (int i = 0; i < 16; ++i) log_sum += std::log(20.0 + 0.2 * (4 * i + 1.5));
  const double world = std::exp(log_sum / 16.0);
  EXPECT_NEAR(
      curve(20.0) / 20.0,
      threshold_cd_m2(ThresholdCurve::ward, 50.0) / threshold_cd_m2(ThresholdCurve::ward, world),
      1e-4);
}

TEST(HistogramAdjustment, BadInputIsRefused) {
  const ViewingConditions viewing;
  tests::expect_error<base::InputError>(
      [&] { histogram_adjustment(light_image(4, 4, [](int, int) { return 0.0; }), viewing); },
      "no pixel of the image has light to adapt to; accepted: at least one of 0.0001 cd/m2");
  tests::expect_error<base::InputError>(
      [&] { histogram_adjustment(make_rgb_image(2, 2, Encoding::display), viewing); },
      "tone curves are of light, but the image is display; accepted: luminance_cd_m2");
  HistogramSettings settings;
  settings.bins = 1;
  tests::expect_error<base::InputError>(
      [&] { histogram_adjustment(window_scene(), viewing, settings); },
      "bins are 1; accepted: 2 and more");
}

TEST(PhotographicCurve, IsTheClosedForm) {
  const ViewingConditions viewing = display_1_to_100();
  const Image uniform = light_image(8, 8, [](int, int) { return 7.0; });
  ReinhardSettings settings;
  settings.white_cd_m2 = 7000.0;
  const ToneCurve curve = photographic_curve(uniform, viewing, settings);
  const double white = 0.18 / 7.0 * 7000.0;
  for (const double l : {0.5, 7.0, 100.0, 5000.0}) {
    const double scaled = 0.18 / 7.0 * l;
    const double expected = 1.0 + 99.0 * scaled * (1.0 + scaled / (white * white)) / (1.0 + scaled);
    EXPECT_NEAR(curve(l) / expected, 1.0, 2e-3) << l;
  }
  EXPECT_NEAR(curve(7000.0), 100.0, 1e-6);
  expect_monotone_within(curve, display_range(viewing));
  settings.key = 0.0;
  tests::expect_error<base::InputError>([&] { photographic_curve(uniform, viewing, settings); },
                                        "the key is 0; accepted: above 0");
}

TEST(PhotographicCurve, DoesNotDependOnTheUnitOfLight) {
  Image light = window_scene();
  const ToneCurve once = photographic_curve(light, display_1_to_100());
  for (float& value : light.pixels) value *= 16.0F;
  const ToneCurve brighter = photographic_curve(light, display_1_to_100());
  for (double l = 0.1; l < 1e4; l *= 3.0) EXPECT_NEAR(brighter(16.0 * l) / once(l), 1.0, 1e-6);
}

TEST(ToneMapped, ScalesColoursAndKeepsNonFinitePixels) {
  Image light = make_rgb_image(3, 1, Encoding::luminance_cd_m2);
  light.pixels = {10.0F, 20.0F, 5.0F, std::numeric_limits<float>::quiet_NaN(), 1.0F, 1.0F,
                  0.0F,  0.0F,  0.0F};
  const Image shown = tone_mapped(light, linear_tone_curve({1.0, 100.0}, 3.0));
  EXPECT_NEAR(shown.at(0, 0, 0), 30.0F, 1e-3F);
  EXPECT_NEAR(shown.at(0, 0, 1), 60.0F, 1e-3F);
  EXPECT_TRUE(std::isnan(shown.at(1, 0, 0)));
  EXPECT_NEAR(shown.at(2, 0, 2), 1.0F, 1e-6F);
  EXPECT_EQ(shown.encoding, Encoding::luminance_cd_m2);
}

TEST(AcesToneMapped, ShowsTheKnownCodeValuesAsLight) {
  const ColorManagement colors;
  Image scene = make_rgb_image(2, 1, Encoding::scene_linear);
  scene.pixels = {0.09F, 0.09F, 0.09F, 0.5F, 0.5F, 0.5F};
  ViewingConditions viewing = display_1_to_100();
  viewing.black_cd_m2 = 0.0;
  viewing.exposure_ev = 1.0;
  // 0.18 and 1.0 are 0.35595 and 0.81197 in sRGB.
  const Image sdr = aces_tone_mapped(scene, colors, viewing);
  EXPECT_NEAR(sdr.at(0, 0), 100.0 * std::pow((0.35595 + 0.055) / 1.055, 2.4), 0.02);
  EXPECT_NEAR(sdr.at(1, 0), 100.0 * std::pow((0.81197 + 0.055) / 1.055, 2.4), 0.02);
  viewing.transfer = DisplayTransfer::pq;
  viewing.peak_cd_m2 = 1500.0;
  // PQ signal 0.33259 of the 1000 cd/m2 transform is 15 cd/m2.
  EXPECT_NEAR(aces_tone_mapped(scene, colors, viewing).at(0, 0), 15.0F, 0.1F);
  viewing.transfer = DisplayTransfer::hlg;
  tests::expect_error<base::InputError>(
      [&] { aces_tone_mapped(scene, colors, viewing); },
      "no ACES output transform for the display transfer \"hlg\"; accepted: srgb, pq");
}

}  // namespace
}  // namespace perception
