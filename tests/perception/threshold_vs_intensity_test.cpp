#include "perception/threshold_vs_intensity.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "tests/expect_error.h"

namespace perception {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double ward(double luminance) { return threshold_cd_m2(ThresholdCurve::ward, luminance); }
double cones(double luminance) {
  return threshold_cd_m2(ThresholdCurve::ferwerda_cones, luminance);
}
double rods(double luminance) { return threshold_cd_m2(ThresholdCurve::ferwerda_rods, luminance); }

struct Anchor {
  double luminance;
  double ward;
  double cones;
  double rods;
};

// From the published pieces in double precision, computed apart from this code.
constexpr Anchor kAnchors[] = {
    {1e-6, 0.00138038, 0.190546, 0.00138038}, {1e-4, 0.00138038, 0.190546, 0.00138038},
    {1e-3, 0.00184003, 0.190546, 0.00184003}, {0.01, 0.00547234, 0.193277, 0.00547234},
    {0.03, 0.0127002, 0.203886, 0.0127002},   {0.1, 0.0402717, 0.231643, 0.0402717},
    {0.5, 0.201359, 0.319512, 0.201359},      {1.0, 0.391302, 0.391302, 0.402717},
    {3.0, 0.591154, 0.591154, 1.20815},       {10.0, 1.07190, 1.07190, 4.02717},
    {30.0, 2.13206, 2.13206, 12.0815},        {50.0, 3.08795, 3.08795, 20.1359},
    {100.0, 5.55904, 5.55904, 40.2717},       {1000.0, 55.5904, 55.5904, 402.717}};

TEST(ThresholdVsIntensity, PublishedCurvesAtFourteenLuminances) {
  for (const Anchor& anchor : kAnchors) {
    EXPECT_NEAR(ward(anchor.luminance) / anchor.ward, 1.0, 5e-6) << anchor.luminance;
    EXPECT_NEAR(cones(anchor.luminance) / anchor.cones, 1.0, 5e-6) << anchor.luminance;
    EXPECT_NEAR(rods(anchor.luminance) / anchor.rods, 1.0, 5e-6) << anchor.luminance;
  }
}

TEST(ThresholdVsIntensity, WardTakesTheMoreSensitiveOfRodsAndCones) {
  for (double l = -6.0; l < 5.0; l += 0.0137) {
    const double luminance = std::pow(10.0, l);
    // 1e-4: the crossing is published with three digits.
    EXPECT_NEAR(ward(luminance) / std::min(cones(luminance), rods(luminance)), 1.0, 1e-4) << l;
  }
}

TEST(ThresholdVsIntensity, TheLiteralPiecesDoNotMeet) {
  const double rod_break = std::pow(10.0, -1.44);
  EXPECT_NEAR(ward(rod_break * (1.0 - 1e-12)), 0.0150310, 5e-8);
  EXPECT_NEAR(ward(rod_break * (1.0 + 1e-12)), 0.0146218, 5e-8);
  const double cone_break = std::pow(10.0, 1.9);
  EXPECT_NEAR(ward(cone_break * (1.0 - 1e-12)), 4.44772, 5e-6);
  EXPECT_NEAR(ward(cone_break * (1.0 + 1e-12)), 4.41570, 5e-6);
}

TEST(ThresholdVsIntensity, TheSmoothVariantIsContinuousRisingAndStaysNear) {
  double before = threshold_cd_m2(ThresholdCurve::ward_smooth, 1e-6);
  for (double l = -6.0; l < 5.0; l += 1e-3) {
    const double luminance = std::pow(10.0, l);
    const double here = threshold_cd_m2(ThresholdCurve::ward_smooth, luminance);
    EXPECT_GE(here, before * (1.0 - 1e-12)) << l;
    EXPECT_LT(here / before, 1.004) << l;  // a step of 2.7 % would show
    EXPECT_NEAR(here / ward(luminance), 1.0, 0.04) << l;
    before = here;
  }
  EXPECT_NEAR(threshold_cd_m2(ThresholdCurve::ward_smooth, 100.0) / 5.55904, 1.0, 0.005);
}

TEST(ThresholdVsIntensity, HdrVdp2) {
  const double expected[][2] = {{0.01, 0.00495}, {0.1, 0.01757},   {1.0, 0.0639},
                                {10.0, 0.35025}, {100.0, 3.31984}, {1000.0, 33.155}};
  for (const auto& [luminance, threshold] : expected) {
    EXPECT_NEAR(threshold_cd_m2(ThresholdCurve::hdr_vdp2, luminance) / threshold, 1.0, 1e-3);
  }
  EXPECT_NEAR(hdr_vdp2_luminance_sensitivity(1e6), 30.162, 1e-3);
  EXPECT_NEAR(hdr_vdp3_luminance_sensitivity(1e6), 315.98, 1e-2);
}

TEST(ThresholdVsIntensity, WeberIsTwoPerCent) {
  EXPECT_DOUBLE_EQ(threshold_cd_m2(ThresholdCurve::weber, 50.0), 1.0);
}

TEST(ThresholdVsIntensity, DarknessAndNonFiniteValuesAreDefined) {
  for (const std::string& name : threshold_curve_names()) {
    const ThresholdCurve curve = threshold_curve_from_text(name);
    EXPECT_EQ(to_string(curve), name);
    EXPECT_TRUE(std::isnan(threshold_cd_m2(curve, std::nan(""))));
    EXPECT_EQ(threshold_cd_m2(curve, kInfinity), kInfinity);
    EXPECT_EQ(threshold_cd_m2(curve, -1.0), threshold_cd_m2(curve, 0.0)) << name;
    EXPECT_EQ(threshold_cd_m2(curve, -kInfinity), threshold_cd_m2(curve, 0.0)) << name;
    EXPECT_NEAR(threshold_cd_m2(curve, 0.0), threshold_cd_m2(curve, 1e-30), 1e-15) << name;
  }
  EXPECT_EQ(threshold_cd_m2(ThresholdCurve::hdr_vdp2, 0.0), 0.0);
  EXPECT_NEAR(ward(0.0), std::pow(10.0, -2.86), 1e-15);
}

TEST(ThresholdVsIntensity, NamesAreReadLeniently) {
  EXPECT_EQ(threshold_curve_from_text("Ward-Smooth"), ThresholdCurve::ward_smooth);
  tests::expect_error<base::InputError>(
      [] { threshold_curve_from_text("wards"); },
      "unknown threshold curve \"wards\"; did you mean \"ward\"? known: ferwerda_cones, "
      "ferwerda_rods, ward, ward_smooth, hdr_vdp2, weber");
}

}  // namespace
}  // namespace perception
