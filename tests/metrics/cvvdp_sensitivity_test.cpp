#include "metrics/cvvdp_sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using metrics::CvvdpSensitivity;

double sensitivity(std::size_t channel, double luminance_cd_m2, double frequency_cpd) {
  return metrics::cvvdp_sensitivity_of(CvvdpSensitivity().at(frequency_cpd)[channel],
                                       luminance_cd_m2);
}

TEST(CvvdpSensitivity, IsTheProgramsAt100CandelasPerSquareMetre) {
  // Sampled from the program's full table.
  const double frequencies[] = {0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
  const double program[3][7] = {{74.504, 151.46, 288.11, 311.98, 179.13, 57.376, 11.453},
                                {330.07, 351.16, 294.15, 190.68, 105.02, 52.990, 25.259},
                                {75.019, 79.227, 63.755, 40.359, 22.217, 11.260, 5.368}};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t f = 0; f < 7; ++f) {
      EXPECT_NEAR(sensitivity(channel, 100.0, frequencies[f]) / program[channel][f], 1.0, 0.006)
          << channel << " at " << frequencies[f];
    }
  }
}

TEST(CvvdpSensitivity, HasTheKeptNodes) {
  // Nodes 15 and 13: 5.5957 cd/m2 and 1.502 cpd.
  const double luminance = 0.005 * std::pow(2e6, 15.0 / 31.0);
  const double frequency = 0.1 * std::pow(640.0, 13.0 / 31.0);
  EXPECT_NEAR(std::log10(sensitivity(0, luminance, frequency)), 2.1949, 1e-9);
  EXPECT_NEAR(std::log10(sensitivity(1, luminance, frequency)), 2.1547, 1e-9);
  EXPECT_NEAR(std::log10(sensitivity(2, luminance, frequency)), 1.5077, 1e-9);
}

TEST(CvvdpSensitivity, RedGreenFallsToAFifthBelowOne) {
  EXPECT_NEAR(sensitivity(1, 0.005, 30.0), 0.2, 1e-6);
  EXPECT_GT(sensitivity(1, 0.005, 10.0), 1.0);
  EXPECT_LT(sensitivity(0, 0.005, 30.0), 0.01);  // the others fall further
}

TEST(CvvdpSensitivity, StaysAsAtTheEndsBeyondThem) {
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(sensitivity(channel, 1e-4, 4.0), sensitivity(channel, 0.005, 4.0));
    EXPECT_EQ(sensitivity(channel, 1e5, 4.0), sensitivity(channel, 1e4, 4.0));
    EXPECT_EQ(sensitivity(channel, 10.0, 0.01), sensitivity(channel, 10.0, 0.1));
    EXPECT_EQ(sensitivity(channel, 10.0, 100.0), sensitivity(channel, 10.0, 64.0));
  }
}

}  // namespace
