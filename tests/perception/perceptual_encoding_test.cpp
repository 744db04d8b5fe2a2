#include "perception/perceptual_encoding.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tests/expect_input_error.h"

namespace {

using perception::PerceptualCurve;
using perception::pu_decode;
using perception::pu_encode;

constexpr std::array<PerceptualCurve, 4> kCurves{
    PerceptualCurve::banding, PerceptualCurve::banding_glare, PerceptualCurve::peaks,
    PerceptualCurve::peaks_glare};

TEST(PerceptualEncoding, HasTheValuesOfTheRecommendedCurve) {
  const std::pair<double, double> vectors[] = {
      {0.01, 0.3722},     {0.1, 5.7171},     {1.0, 36.5439},    {10.0, 123.6475},
      {50.0, 212.7873},   {100.0, 256.3839}, {200.0, 302.7743}, {1000.0, 420.0969},
      {4000.0, 527.4939}, {1e4, 595.3939}};
  for (const auto& [luminance, value] : vectors) {
    EXPECT_NEAR(pu_encode(luminance, PerceptualCurve::banding_glare), value, 6e-5) << luminance;
  }
}

TEST(PerceptualEncoding, HasTheValuesOfTheOtherCurves) {
  EXPECT_NEAR(pu_encode(0.01, PerceptualCurve::banding), 6.30526, 1e-5);
  EXPECT_NEAR(pu_encode(100.0, PerceptualCurve::banding), 261.75173, 1e-5);
  EXPECT_NEAR(pu_encode(1e4, PerceptualCurve::banding), 520.46731, 1e-5);
  EXPECT_NEAR(pu_encode(1.0, PerceptualCurve::peaks), 85.54201, 1e-5);
  EXPECT_NEAR(pu_encode(1e4, PerceptualCurve::peaks), 380.98532, 1e-5);
  EXPECT_NEAR(pu_encode(1.0, PerceptualCurve::peaks_glare), 47.00903, 1e-5);
  EXPECT_NEAR(pu_encode(1e4, PerceptualCurve::peaks_glare), 407.50662, 1e-5);
}

TEST(PerceptualEncoding, EveryCurveRisesAndPutsWhiteNearThePeak) {
  for (const PerceptualCurve curve : kCurves) {
    double last = -1.0;
    for (double log10_luminance = -2.3; log10_luminance <= 4.0; log10_luminance += 0.02) {
      const double value = pu_encode(std::pow(10.0, log10_luminance), curve);
      ASSERT_GT(value, last) << to_string(curve) << " at 10^" << log10_luminance;
      last = value;
    }
    EXPECT_NEAR(pu_encode(100.0, curve), perception::kPuPeak, 6.0) << to_string(curve);
  }
}

TEST(PerceptualEncoding, DecodingIsTheInverse) {
  for (const PerceptualCurve curve : kCurves) {
    for (const double luminance : {0.01, 0.1, 1.0, 17.0, 100.0, 3000.0, 1e4}) {
      EXPECT_NEAR(pu_decode(pu_encode(luminance, curve), curve) / luminance, 1.0, 1e-9)
          << to_string(curve) << " at " << luminance;
    }
  }
}

TEST(PerceptualEncoding, CurvesDiffer) {
  const double recommended = pu_encode(1.0, PerceptualCurve::banding_glare);
  for (const PerceptualCurve curve :
       {PerceptualCurve::banding, PerceptualCurve::peaks, PerceptualCurve::peaks_glare}) {
    EXPECT_GT(std::abs(pu_encode(1.0, curve) - recommended), 1.0) << to_string(curve);
  }
}

TEST(PerceptualEncoding, TakesTheNearestBoundOutsideTheRange) {
  const auto curve = PerceptualCurve::banding_glare;
  EXPECT_EQ(pu_encode(-1.0, curve), pu_encode(0.005, curve));
  EXPECT_EQ(pu_encode(0.0, curve), pu_encode(0.005, curve));
  EXPECT_EQ(pu_encode(2e4, curve), pu_encode(1e4, curve));
  EXPECT_TRUE(std::isnan(pu_encode(std::nan(""), curve)));
  EXPECT_TRUE(perception::is_in_pu_range(0.005));
  EXPECT_TRUE(perception::is_in_pu_range(1e4));
  EXPECT_FALSE(perception::is_in_pu_range(0.004));
  EXPECT_FALSE(perception::is_in_pu_range(10001.0));
  EXPECT_FALSE(perception::is_in_pu_range(std::nan("")));
}

TEST(PerceptualEncoding, RefusesValuesThatNoLuminanceHas) {
  const auto error = [](double value) {
    return tests::input_error_of([&] { pu_decode(value, PerceptualCurve::banding_glare); });
  };
  EXPECT_EQ(error(-1.0),
            "-1 is not a PU value of the encoding \"banding_glare\"; accepted: 0.0000 to 595.3939");
  EXPECT_EQ(
      error(600.0),
      "600 is not a PU value of the encoding \"banding_glare\"; accepted: 0.0000 to 595.3939");
  EXPECT_EQ(error(std::nan("")).substr(0, 3), "nan");
}

TEST(PerceptualEncoding, ReadsNames) {
  for (const PerceptualCurve curve : kCurves) {
    EXPECT_EQ(perception::perceptual_curve_from_text(to_string(curve)), curve);
  }
  EXPECT_EQ(perception::perceptual_curve_from_text("peaks-glare"), PerceptualCurve::peaks_glare);
  EXPECT_EQ(tests::input_error_of([] { perception::perceptual_curve_from_text("bandin"); }),
            "unknown perceptual encoding \"bandin\"; did you mean \"banding\"? known: banding, "
            "banding_glare, peaks, peaks_glare");
}

}  // namespace
