#include "perception/pattern_observer.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "perception/contrast_sensitivity.h"
#include "tests/expect_error.h"

namespace perception {
namespace {

constexpr double kMean_cd_m2 = 30.0;

double threshold_of(const GaborPatch& patch, const PatternObserver& observer, double size_deg = 4.0,
                    double ppd = 60.0) {
  return pattern_threshold(gabor_stimulus(patch, size_deg), kMean_cd_m2, ppd, observer);
}

TEST(GaborThreshold, IsTheInverseOfTheCsfAtThePatchsArea) {
  const GaborPatch patch{.frequency_cpd = 2.0, .sigma_along_deg = 0.3, .sigma_across_deg = 0.6};
  StimulusConditions conditions;
  conditions.area_deg2 = std::numbers::pi * 0.3 * 0.6;
  const double sensitivity =
      contrast_sensitivity(find_csf("castle-achromatic"), 2.0, kMean_cd_m2, conditions);
  EXPECT_DOUBLE_EQ(gabor_threshold(patch, kMean_cd_m2, "castle-achromatic"), 1.0 / sensitivity);
  EXPECT_GT(gabor_threshold(patch, kMean_cd_m2, "castle-achromatic", 10.0), 1.0 / sensitivity);
}

TEST(PatternObserver, SeesItsAnchorAtTheCsf) {
  const GaborPatch anchor{.frequency_cpd = 4.0, .orientation_deg = 90.0};
  for (const char* csf : {"daly", "castle-achromatic", "mannos-sakrison"}) {
    EXPECT_NEAR(threshold_of(anchor, {.csf = csf}) / gabor_threshold(anchor, kMean_cd_m2, csf), 1.0,
                2e-3)
        << csf;
  }
}

TEST(PatternObserver, FollowsTheCsfOverFrequencyForLargePatches) {
  // A patch of many cycles has one frequency only: its threshold goes as 1 / CSF.
  const PatternObserver observer{.csf = "daly"};
  const auto ratio = [&](double frequency) {
    const GaborPatch patch{.frequency_cpd = frequency, .orientation_deg = 90.0};
    return threshold_of(patch, observer) / gabor_threshold(patch, kMean_cd_m2, "daly");
  };
  EXPECT_NEAR(ratio(8.0), 1.0, 0.06);
  EXPECT_NEAR(ratio(12.0), 1.0, 0.12);
}

TEST(PatternObserver, SumsEnergyOverSpaceForExponentTwo) {
  // (integral of (cos gaussian)^2)^(1/2) is proportional to sigma; without an aperture half of
  // sigma needs twice the contrast, as long as the patch keeps to one frequency.
  const PatternObserver observer{.csf = "daly", .pooling_exponent = 2.0, .aperture_deg = 1000.0};
  const auto patch = [](double sigma) {
    return GaborPatch{.frequency_cpd = 8.0, .sigma_along_deg = sigma, .sigma_across_deg = sigma};
  };
  EXPECT_NEAR(threshold_of(patch(0.4), observer) / threshold_of(patch(0.8), observer, 8.0), 2.0,
              0.05);
  // With Minkowski exponent beta it is 2^(2 / beta).
  const PatternObserver four{.csf = "daly", .pooling_exponent = 4.0, .aperture_deg = 1000.0};
  EXPECT_NEAR(threshold_of(patch(0.4), four) / threshold_of(patch(0.8), four, 8.0), std::sqrt(2.0),
              0.05);
}

TEST(PatternObserver, LooksThroughItsAperture) {
  const GaborPatch patch{.frequency_cpd = 8.0, .x_deg = 1.5};
  const GaborPatch central{.frequency_cpd = 8.0};
  const PatternObserver observer{.csf = "daly"};
  EXPECT_GT(threshold_of(patch, observer, 8.0), 2.0 * threshold_of(central, observer, 8.0));
}

TEST(PatternObserver, ResolutionAndSizeOfTheFieldHardlyMatter) {
  const PatternObserver observer{.csf = "castle-achromatic"};
  const GaborPatch patch{.frequency_cpd = 4.0, .sigma_along_deg = 0.14, .sigma_across_deg = 0.14};
  const double threshold = threshold_of(patch, observer);
  EXPECT_NEAR(threshold_of(patch, observer, 4.0, 120.0) / threshold, 1.0, 0.01);
  EXPECT_NEAR(threshold_of(patch, observer, 2.5, 60.0) / threshold, 1.0, 0.02);
}

TEST(PatternObserver, RefusesWhatItCannotBe) {
  tests::expect_error<base::InputError>([] { check({.csf = "daly", .pooling_exponent = 0.5}); },
                                        "pooling_exponent is 0.5; accepted: 1 and above");
  tests::expect_error<base::InputError>([] { check({.csf = "daly", .aperture_deg = 0.0}); },
                                        "aperture_deg is 0; accepted: above 0");
  tests::expect_error<base::InputError>(
      [] { check({.csf = "castle-red-green"}); },
      "csf \"castle-red-green\" is of colour; accepted: achromatic functions");
}

}  // namespace
}  // namespace perception
