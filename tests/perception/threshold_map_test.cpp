#include "perception/threshold_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "perception/image_pyramid.h"
#include "tests/expect_error.h"
#include "tests/perception/luminance_patterns.h"

namespace perception {
namespace {

using tests::light_image;

ViewingConditions at_ppd(double ppd) {
  ViewingConditions viewing;
  viewing.pixels_per_degree = ppd;
  return viewing;
}

ThresholdSettings with(const char* profile) {
  ThresholdSettings settings;
  settings.masking = masking_profile(profile);
  return settings;
}

/// A textured picture with a shadow edge.
Image picture(int width = 150, int height = 90) {
  return light_image(width, height, [](int x, int y) {
    const double texture = 1.0 + 0.3 * std::sin(0.9 * x) * std::cos(0.31 * y);
    return (x < 70 ? 80.0 : 15.0) * texture;
  });
}

void expect_same(const ThresholdMap& a, const ThresholdMap& b) {
  EXPECT_EQ(a.adaptation_cd_m2.pixels, b.adaptation_cd_m2.pixels);
  EXPECT_EQ(a.tvi_cd_m2.pixels, b.tvi_cd_m2.pixels);
  EXPECT_EQ(a.elevation.pixels, b.elevation.pixels);
  EXPECT_EQ(a.threshold_cd_m2.pixels, b.threshold_cd_m2.pixels);
}

TEST(ThresholdMap, UniformLightIsTviAlone) {
  for (const char* profile : {"rama99", "yee_compat"}) {
    for (const double luminance : {0.0, 1e-3, 0.5, 30.0, 4000.0}) {
      const ThresholdMap map = threshold_map(
          light_image(97, 41, [=](int, int) { return luminance; }), at_ppd(60.0), with(profile));
      const double tvi = threshold_cd_m2(ThresholdCurve::ward, std::max(luminance, 1e-5));
      for (std::size_t i = 0; i < map.elevation.pixels.size(); ++i) {
        ASSERT_EQ(map.elevation.pixels[i], 1.0F) << luminance;
        ASSERT_NEAR(map.threshold_cd_m2.pixels[i] / tvi, 1.0, 1e-5) << luminance;
      }
    }
  }
}

TEST(ThresholdProfile, TheCalibratedOneIsStricter) {
  const Image light = picture(64, 50);
  const auto threshold = [&](const char* profile) {
    return threshold_map(light, at_ppd(30.0), threshold_profile(profile)).threshold_cd_m2.pixels;
  };
  const auto literal = threshold("rama99");
  const auto calibrated = threshold("rama99_calibrated");
  for (std::size_t i = 0; i < literal.size(); ++i) ASSERT_LT(calibrated[i], literal[i]) << i;
  EXPECT_EQ(threshold_profile("yee_compat").threshold_scale, 1.0);
}

TEST(ThresholdMap, IsTheProductAndNeverBelowTvi) {
  ThresholdSettings settings;
  settings.keeps_bands = true;
  settings.threshold_scale = 0.5;
  settings.curve = ThresholdCurve::ward_smooth;  // the steps of `ward` are spread by tabulation
  const ThresholdMap map = threshold_map(picture(), at_ppd(30.0), settings);
  ASSERT_EQ(map.bands.size(), 6U);
  float most = 0.0F;
  for (std::size_t i = 0; i < map.elevation.pixels.size(); ++i) {
    EXPECT_GE(map.elevation.pixels[i], 1.0F);
    EXPECT_LE(map.elevation.pixels[i], 10.0F);
    EXPECT_EQ(map.threshold_cd_m2.pixels[i], map.tvi_cd_m2.pixels[i] * map.elevation.pixels[i]);
    EXPECT_NEAR(map.tvi_cd_m2.pixels[i] /
                    (0.5 * threshold_cd_m2(ThresholdCurve::ward_smooth,
                                           static_cast<double>(map.adaptation_cd_m2.pixels[i]))),
                1.0, 1e-4);
    for (const BandElevation& band : map.bands) EXPECT_GE(band.elevation.pixels[i], 1.0F);
    most = std::max(most, map.elevation.pixels[i]);
  }
  EXPECT_GT(most, 2.0F);
}

TEST(ThresholdMap, ElevationDoesNotChangeWithTheScaleOfLight) {
  const Image once = picture();
  Image eight_times = once;
  for (float& value : eight_times.pixels) value *= 8.0F;
  EXPECT_EQ(threshold_map(once, at_ppd(40.0)).elevation.pixels,
            threshold_map(eight_times, at_ppd(40.0)).elevation.pixels);
}

TEST(ThresholdMap, MirrorsWithTheImage) {
  const Image light = picture(64, 50);  // even sizes, where decimated pyramids do not mirror
  const ThresholdMap map = threshold_map(light, at_ppd(30.0));
  for (const auto& [in_x, in_y] : {std::pair{true, false}, {false, true}, {true, true}}) {
    const ThresholdMap flipped = threshold_map(tests::mirrored(light, in_x, in_y), at_ppd(30.0));
    EXPECT_EQ(tests::mirrored(flipped.threshold_cd_m2, in_x, in_y).pixels,
              map.threshold_cd_m2.pixels);
  }
}

TEST(ThresholdMap, OfACropIsTheCropOfTheMap) {
  // Away from the crop's border nothing changes: the coarsest octave and the Gaussian of adaptation
  // reach over some 40 pixels at 10 pixels per degree.
  const Image light = picture(320, 280);
  ThresholdSettings settings;
  settings.masking.band_count = 3;
  const ThresholdMap whole = threshold_map(light, at_ppd(10.0), settings);
  const ThresholdMap part = threshold_map(crop(light, 64, 64, 192, 160), at_ppd(10.0), settings);
  for (int y = 60; y < 100; ++y) {
    for (int x = 60; x < 132; ++x) {
      ASSERT_NEAR(part.threshold_cd_m2.at(x, y) / whole.threshold_cd_m2.at(x + 64, y + 64), 1.0F,
                  1e-3F)
          << x << ", " << y;
    }
  }
}

TEST(ThresholdMap, SameBytesForAnyNumberOfThreads) {
  for (const MaskingBands bands : {MaskingBands::octaves, MaskingBands::oriented_octaves}) {
    ThresholdSettings settings;
    settings.masking.bands = bands;
    const auto with_threads = [&](int threads) {
      const base::ThreadLimit limit(threads);
      return threshold_map(picture(301, 211), at_ppd(67.0), settings);
    };
    expect_same(with_threads(1), with_threads(4));
  }
}

TEST(ThresholdMap, ElevationRisesWithTexture) {
  double before = 0.0;
  for (const double amplitude : {0.0, 0.01, 0.05, 0.2, 0.8}) {
    const ThresholdMap map = threshold_map(tests::noise(96, 96, 40.0, amplitude), at_ppd(20.0), {});
    double sum = 0.0;
    for (const float value : map.elevation.pixels) sum += static_cast<double>(value);
    EXPECT_GE(sum, before) << amplitude;
    before = sum;
  }
}

TEST(ThresholdMap, OfAPairIsMutualAndSymmetric) {
  const Image clean = light_image(80, 80, [](int, int) { return 40.0; });
  const Image noisy = tests::noise(80, 80, 40.0, 0.5);
  const ThresholdMap map = threshold_map(clean, noisy, at_ppd(30.0));
  for (const float value : map.elevation.pixels) EXPECT_EQ(value, 1.0F);
  ThresholdSettings yee;
  yee.masking.pair = PairContrast::maximum;
  const ThresholdMap hidden = threshold_map(clean, noisy, at_ppd(30.0), yee);
  EXPECT_GT(*std::max_element(hidden.elevation.pixels.begin(), hidden.elevation.pixels.end()),
            3.0F);
  expect_same(map, threshold_map(noisy, clean, at_ppd(30.0)));
  expect_same(threshold_map(noisy, noisy, at_ppd(30.0)), threshold_map(noisy, at_ppd(30.0)));
}

TEST(ThresholdMap, NonFinitePixelsAreCountedAndStayAlone) {
  Image light = light_image(60, 40, [](int, int) { return 20.0; });
  light.at(7, 3) = std::numeric_limits<float>::quiet_NaN();
  light.at(8, 3) = std::numeric_limits<float>::infinity();
  const ThresholdMap map = threshold_map(light, at_ppd(30.0));
  EXPECT_EQ(map.non_finite.pixels, 2U);
  EXPECT_EQ(map.non_finite.first_x_px, 7);
  EXPECT_EQ(map.non_finite.first_y_px, 3);
  EXPECT_EQ(map.negative_pixels, 0U);
  EXPECT_EQ(count_non_finite(map.threshold_cd_m2).pixels, 2U);
  EXPECT_TRUE(std::isnan(map.elevation.at(8, 3)));
  // The neighbours see their surround in the hole, not an edge.
  EXPECT_EQ(map.elevation.at(6, 3), 1.0F);
  EXPECT_NEAR(map.adaptation_cd_m2.at(6, 3), 20.0F, 1e-3F);
  const Image nothing =
      light_image(5, 5, [](int, int) { return std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(threshold_map(nothing, at_ppd(30.0)).non_finite.pixels, 25U);
}

TEST(ThresholdMap, NegativeLightIsCountedAsDarkness) {
  Image light = light_image(60, 40, [](int, int) { return 20.0; });
  light.at(30, 20) = -5.0F;
  const ThresholdMap map = threshold_map(light, at_ppd(30.0));
  EXPECT_EQ(map.negative_pixels, 1U);
  EXPECT_EQ(map.non_finite.pixels, 0U);
  light.at(30, 20) = 0.0F;
  expect_same(map, threshold_map(light, at_ppd(30.0)));
}

TEST(ThresholdMap, WorksOnTinyImagesAndColors) {
  for (const int size : {1, 2, 3, 5}) {
    for (const char* profile : {"rama99", "yee_compat"}) {
      const ThresholdMap map =
          threshold_map(tests::noise(size, 1, 10.0, 0.5), at_ppd(67.0), with(profile));
      for (const float value : map.threshold_cd_m2.pixels) EXPECT_TRUE(std::isfinite(value));
    }
  }
  Image color(4, 4, {"R", "G", "B", "A"}, Encoding::luminance_cd_m2);
  for (std::size_t i = 0; i < color.pixels.size(); ++i) {
    color.pixels[i] = i % 4 == 1 ? 100.0F : 0.0F;  // green light
  }
  EXPECT_NEAR(threshold_map(color, at_ppd(30.0)).adaptation_cd_m2.at(1, 1), 71.52F, 1e-3F);
}

TEST(ThresholdMap, BadInputIsRefused) {
  tests::expect_error<base::InputError>(
      [] { threshold_map(make_rgb_image(2, 2, Encoding::display), at_ppd(30.0)); },
      "thresholds are of light, but the image is display; accepted: luminance_cd_m2, through the "
      "display model");
  tests::expect_error<base::InputError>([] { threshold_map(picture(), at_ppd(0.0)); },
                                        "pixels per degree are 0; accepted: above 0");
  tests::expect_error<base::InputError>(
      [] { threshold_map(picture(3, 4), picture(4, 4), at_ppd(30.0)); },
      "the images are 3x4 and 4x4 pixels; accepted: equal sizes");
  ThresholdSettings settings;
  settings.threshold_scale = -1.0;
  tests::expect_error<base::InputError>([&] { threshold_map(picture(), at_ppd(30.0), settings); },
                                        "threshold_scale is -1; accepted: above 0");
}

TEST(DetectionProbability, IsHalfOr63PerCentAtOneThreshold) {
  EXPECT_NEAR(detection_probability(1.0), 0.5, 1e-12);
  EXPECT_NEAR(detection_probability(-1.0, OneThreshold::daly), 1.0 - std::exp(-1.0), 1e-12);
  EXPECT_EQ(detection_probability(0.0), 0.0);
  EXPECT_NEAR(detection_probability(2.0), 1.0 - std::exp2(-std::pow(2.0, 3.5)), 1e-12);
  EXPECT_TRUE(std::isnan(detection_probability(std::nan(""))));
  double before = 0.0;
  for (double t = 0.01; t < 4.0; t *= 1.2) {
    EXPECT_GT(detection_probability(t), before);
    before = detection_probability(t);
  }
}

/// Yee's formulas for one pixel of two images, read directly and in double precision.
double yee_elevation(const Image& a, const Image& b, int x, int y, double ppd) {
  const MaskingSettings settings = masking_profile("yee_compat");
  const CsfInfo& csf = find_csf("barten-1989");
  LowPassStack stack_a(a, LowPassStack::Kind::repeated_kernel);
  LowPassStack stack_b(b, LowPassStack::Kind::repeated_kernel);
  std::vector<double> la;
  std::vector<double> lb;
  for (int i = 0; i < 8; ++i) {
    la.push_back(static_cast<double>(stack_a.current().at(x, y)));
    lb.push_back(static_cast<double>(stack_b.current().at(x, y)));
    stack_a.advance();
    stack_b.advance();
  }
  std::size_t level = 0;
  while (level < 7 && std::exp2(static_cast<double>(level)) <= a.width_px / ppd) ++level;
  const double adaptation = std::max(0.5 * (la[level] + lb[level]), 1e-5);
  double sum = 0.0;
  double factor = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    const double f = ppd / std::exp2(static_cast<double>(i) + 1.0);
    const double ca = std::abs(la[i] - la[i + 1]) / std::max(la[i + 2], 1e-5);
    const double cb = std::abs(lb[i] - lb[i + 1]) / std::max(lb[i + 2], 1e-5);
    const double c = std::max(ca, cb);
    const double f_csf = 525.1536 / contrast_sensitivity(csf, f, 100.0);
    const double m = c * contrast_sensitivity(csf, f, adaptation);
    sum += c;
    factor += c * f_csf * threshold_elevation(m, yee_masking_curve());
  }
  return std::clamp(factor / std::max(sum, 1e-5), 1.0, settings.largest_elevation);
}

TEST(YeeProfile, IsTheFormulaOfTheMetric) {
  const Image a = picture(90, 60);
  const Image b = tests::noise(90, 60, 30.0, 0.02);
  const ThresholdMap map = threshold_map(a, b, at_ppd(8.0), with("yee_compat"));
  for (const auto& [x, y] : {std::pair{3, 2}, {40, 30}, {71, 9}, {89, 59}}) {
    EXPECT_NEAR(map.elevation.at(x, y) / yee_elevation(a, b, x, y, 8.0), 1.0, 1e-3);
  }
}

TEST(ThresholdField, AnswersWhatTheMapHolds) {
  const Image light = picture();
  const ThresholdMap map = threshold_map(light, at_ppd(40.0));
  const ThresholdField field(light, at_ppd(40.0));
  EXPECT_EQ(field.width_px(), 150);
  EXPECT_EQ(field.height_px(), 90);
  for (const auto& [x, y] : {std::pair{0, 0}, {70, 40}, {149, 89}}) {
    EXPECT_NEAR(field.threshold_cd_m2(x, y) / static_cast<double>(map.threshold_cd_m2.at(x, y)),
                1.0, 1e-6);
    EXPECT_EQ(field.elevation(x, y), static_cast<double>(map.elevation.at(x, y)));
  }
  const double between = 0.5 * (field.elevation(10, 10) + field.elevation(11, 10));
  EXPECT_NEAR(field.elevation(10.5, 10.0), between, 1e-12);
  EXPECT_EQ(field.elevation(-7.0, 500.0), field.elevation(0.0, 89.0));
  // A brighter estimate: only TVI follows.
  EXPECT_NEAR(field.threshold_cd_m2(5, 5, 100.0), 5.55904 * field.elevation(5, 5), 1e-3);
  double sum = 0.0;
  for (const float value : light.pixels) sum += static_cast<double>(value);
  EXPECT_NEAR(field.mean_threshold_cd_m2(),
              threshold_cd_m2(ThresholdCurve::ward, sum / static_cast<double>(light.pixels.size())),
              1e-9);
}

TEST(ThresholdField, TargetsNeedBands) {
  const Image light = tests::grating(128, 50.0, 0.1, 4.0 / 60.0);
  const ThresholdField field(light, at_ppd(60.0), {}, ThresholdField::Keeps::bands);
  const double masked = field.threshold_cd_m2(64, 64, MaskingTarget{4.0, std::nullopt});
  EXPECT_GT(masked, 3.0 * threshold_cd_m2(ThresholdCurve::ward, field.adaptation_cd_m2(64, 64)));
  const ThresholdField plain(light, at_ppd(60.0));
  tests::expect_error<base::InputError>(
      [&] {
        plain.threshold_cd_m2(1, 1, MaskingTarget{4.0, std::nullopt});
      },
      "a masking target was asked of a threshold field without bands; accepted: fields that keep "
      "bands");
}

TEST(ThresholdField, RefusesNonFinitePreviews) {
  Image light = picture();
  light.at(4, 2) = std::numeric_limits<float>::quiet_NaN();
  tests::expect_error<base::InputError>(
      [&] { ThresholdField(light, at_ppd(40.0)); },
      "the preview has 1 non-finite pixels, the first at 4,2; accepted: finite light");
}

}  // namespace
}  // namespace perception
