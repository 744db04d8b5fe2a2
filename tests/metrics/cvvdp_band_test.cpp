#include "metrics/cvvdp_band.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metrics/cvvdp_pyramid.h"

namespace {

using metrics::CvvdpChannelPlanes;
using metrics::CvvdpLevel;
using metrics::CvvdpSensitivityCurves;
using metrics::Plane;

/// Sensitivity 10^exponent in all channels at every luminance.
CvvdpSensitivityCurves flat_curves(double exponent) {
  CvvdpSensitivityCurves curves;
  for (auto& curve : curves) curve.fill(exponent);
  return curves;
}

CvvdpChannelPlanes uniform(int width_px, int height_px, std::array<float, 3> values) {
  CvvdpChannelPlanes planes;
  for (std::size_t c = 0; c < 3; ++c) {
    planes[c] = Plane<float>(width_px, height_px);
    planes[c].values.assign(planes[c].values.size(), values[c]);
  }
  return planes;
}

TEST(CvvdpBand, ThePowerIsZeroAtZero) {
  EXPECT_EQ(metrics::cvvdp_power(0.0, 2.3), 0.0);
  EXPECT_NEAR(metrics::cvvdp_power(3.0, 2.0), 9.00006, 1e-9);
  EXPECT_NEAR(metrics::cvvdp_power(1.0, 0.25), 1.0000025 - std::pow(1e-5, 0.25), 1e-9);
}

TEST(CvvdpBand, OfAnUnmaskedPixelIsThePowerOfItsContrast) {
  // Both coarse levels are uniform at 50 cd/m2; one red-green value differs by 0.5.
  CvvdpLevel fine{uniform(9, 9, {50.0F, 0.0F, 0.0F}), uniform(9, 9, {50.0F, 0.0F, 0.0F})};
  const CvvdpLevel coarse{uniform(5, 5, {50.0F, 0.0F, 0.0F}), uniform(5, 5, {50.0F, 0.0F, 0.0F})};
  fine.test[1].row(4)[4] = 0.5F;
  const auto difference = metrics::cvvdp_band_difference(fine, coarse, flat_curves(2.0), 2.0);
  const double correction = std::pow(10.0, -0.2797423303127289 / 20.0);
  const double seen = 2.0 * (0.5 / 50.0) * 100.0 * correction * 1.45;
  const double raised = metrics::cvvdp_power(seen, 2.264355182647705);
  const double largest = std::pow(10.0, 2.5642454624176025);
  EXPECT_NEAR(difference[1].row(4)[4], raised * largest / (raised + largest), 1e-4);
  EXPECT_EQ(difference[0].row(4)[4], 0.0F);
  EXPECT_EQ(difference[1].row(4)[5], 0.0F);
}

TEST(CvvdpBand, SharedContrastMasksAcrossChannels) {
  const auto level = [](float step, float shared) {
    CvvdpChannelPlanes fine = uniform(20, 20, {50.0F, 0.0F, 0.0F});
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) {
        fine[0].row(y)[x] += ((x + y) % 2 == 0 ? 1.0F : -1.0F) * shared;
        fine[2].row(y)[x] = step;
      }
    }
    return fine;
  };
  const CvvdpChannelPlanes coarse = uniform(10, 10, {50.0F, 0.0F, 0.0F});
  const auto at_centre = [&](float shared) {
    const auto difference = metrics::cvvdp_band_difference(
        {level(0.0F, shared), level(1.0F, shared)}, {coarse, coarse}, flat_curves(2.0), 1.0);
    return difference[2].row(10)[10];
  };
  EXPECT_GT(at_centre(0.0F), 1.5F * at_centre(20.0F));
  EXPECT_GT(at_centre(20.0F), 0.0F);
}

TEST(CvvdpBand, DifferencesNeverExceedTheSoftClamp) {
  CvvdpLevel fine{uniform(8, 8, {50.0F, 0.0F, 0.0F}), uniform(8, 8, {50.0F, 0.0F, 0.0F})};
  const CvvdpLevel coarse{uniform(4, 4, {0.0F, 0.0F, 0.0F}), uniform(4, 4, {50.0F, 0.0F, 0.0F})};
  const auto difference = metrics::cvvdp_band_difference(fine, coarse, flat_curves(3.0), 2.0);
  EXPECT_NEAR(difference[0].row(3)[3], std::pow(10.0, 2.5642454624176025), 0.5);
}

TEST(CvvdpBand, TheBaseBandIsTakenOverTheMean) {
  CvvdpLevel last{uniform(2, 1, {40.0F, 2.0F, 0.0F}), uniform(2, 1, {80.0F, 2.0F, 0.0F})};
  last.reference[0].values = {30.0F, 50.0F};  // mean 40
  const auto difference = metrics::cvvdp_base_difference(last, flat_curves(1.0));
  const double gain = 10.0 * std::pow(10.0, -0.2797423303127289 / 20.0);
  EXPECT_NEAR(difference[0].values[0], gain * (1.0 - 0.75), 1e-5);
  EXPECT_NEAR(difference[0].values[1], gain * (1.25 - 1.0), 1e-5);
  EXPECT_NEAR(difference[1].values[0], gain * (2.0 / 40.0 - 2.0 / 80.0), 1e-5);
}

}  // namespace
