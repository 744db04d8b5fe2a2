#include "perception/tabulated_curve.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace perception {
namespace {

TEST(TabulatedCurve, FollowsPowerLawsToSixDigits) {
  for (const double p : {-0.5, 0.45, 0.7, 1.0, 2.0}) {
    const TabulatedCurve curve([p](double x) { return std::pow(x + 1e-3, p); });
    for (double l = -23.9; l < 23.9; l += 0.01037) {
      const auto x = static_cast<float>(std::exp2(l));
      const double exact = std::pow(static_cast<double>(x) + 1e-3, p);
      EXPECT_NEAR(static_cast<double>(curve(x)) / exact, 1.0, 2e-5) << p << " " << x;
    }
  }
}

TEST(TabulatedCurve, IsExactAtPowersOfTwoAndBeyondItsRange) {
  const TabulatedCurve curve([](double x) { return std::sqrt(x); });
  EXPECT_EQ(curve(4.0F), 2.0F);
  EXPECT_EQ(curve(0x1p-24F), 0x1p-12F);
  EXPECT_EQ(curve(0x1p30F), 0x1p15F);
  EXPECT_EQ(curve(0.0F), 0.0F);
  EXPECT_EQ(curve(0x1p-25F), 0x1p-13F);  // a straight line from 0
  EXPECT_TRUE(std::isnan(curve(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(curve(-1.0F)));
  EXPECT_TRUE(std::isinf(curve(std::numeric_limits<float>::infinity())));
}

}  // namespace
}  // namespace perception
