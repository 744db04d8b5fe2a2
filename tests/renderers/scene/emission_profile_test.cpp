#include "renderers/scene/emission_profile.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace renderers::scene {
namespace {

using Profile = std::vector<float>;

float factor_at(const Profile& profile, double angle_deg) {
  return emission_factor(profile,
                         static_cast<float>(std::cos(angle_deg * std::numbers::pi / 180.0)));
}

TEST(EmissionProfile, IsLinearInTheAngleBetweenItsValues) {
  const Profile profile{2.0F, 1.0F, 0.25F, 0.0F};  // 0, 30, 60, 90 degrees
  EXPECT_NEAR(factor_at(profile, 0.0), 2.0F, 1e-3F);
  EXPECT_NEAR(factor_at(profile, 15.0), 1.5F, 1e-5F);
  EXPECT_NEAR(factor_at(profile, 30.0), 1.0F, 1e-5F);
  EXPECT_NEAR(factor_at(profile, 50.0), 0.5F, 1e-5F);
  EXPECT_NEAR(factor_at(profile, 75.0), 0.125F, 1e-5F);
  EXPECT_NEAR(factor_at(profile, 90.0), 0.0F, 1e-5F);
  // Cosines beyond 1 by rounding, and none at all.
  EXPECT_EQ(emission_factor(profile, 1.0001F), 2.0F);
  EXPECT_EQ(emission_factor(profile, 0.0F), 0.0F);
  EXPECT_EQ(emission_factor({}, 0.3F), 1.0F);
}

/// Of cos^n the integral is 2 / (n + 2); of 1 - 2 t / pi it is 1 / 2.
TEST(EmissionProfile, FluxIsTheIntegralOverProjectedDirections) {
  EXPECT_EQ(flux_factor({}), 1.0);
  EXPECT_NEAR(flux_factor(Profile{1.0F, 1.0F}), 1.0, 1e-12);
  EXPECT_NEAR(flux_factor(Profile{0.5F, 0.5F, 0.5F, 0.5F}), 0.5, 1e-12);
  EXPECT_NEAR(flux_factor(Profile{1.0F, 0.0F}), 0.5, 1e-12);
  for (const double exponent : {1.0, 8.0, 60.0}) {
    Profile profile;
    for (int i = 0; i <= 900; ++i) {
      profile.push_back(static_cast<float>(
          std::pow(std::fabs(std::cos(i * std::numbers::pi / 1800.0)), exponent)));
    }
    EXPECT_NEAR(flux_factor(profile), 2.0 / (exponent + 2.0), 1e-5) << exponent;
  }
}

/// The same by sums over the factor itself.
TEST(EmissionProfile, FluxIsThatOfTheFactor) {
  const Profile profile{0.2F, 3.0F, 0.0F, 0.7F, 1.1F};
  constexpr int kSteps = 200'000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine2 = (i + 0.5) / kSteps;  // uniform in cos^2: projected directions
    sum += static_cast<double>(emission_factor(profile, static_cast<float>(std::sqrt(cosine2))));
  }
  EXPECT_NEAR(flux_factor(profile), sum / kSteps, 1e-4);
}

}  // namespace
}  // namespace renderers::scene
