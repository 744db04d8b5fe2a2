#include "metrics/vector_math.h"

#include <gtest/gtest.h>

#include <cmath>

#include "perception/color_conversion.h"

namespace {

/// Largest relative error of a function of one float against one in double precision.
template <typename Function, typename Exact>
double largest_relative_error(float from, float to, const Function& function, const Exact& exact) {
  double largest = 0.0;
  for (float x = from; x < to; x *= 1.0007F) {
    const double expected = exact(static_cast<double>(x));
    const double error = std::abs(static_cast<double>(function(x)) - expected);
    largest = std::max(largest, error / std::abs(expected));
  }
  return largest;
}

/// Half a unit in the last place of a float, relative.
constexpr double kHalfUlp = 0.5 * 0x1p-23;

TEST(VectorMath, CubeRootIsRoundedCorrectly) {
  const double error = largest_relative_error(1e-25F, 1e25F, metrics::cube_root,
                                              [](double x) { return std::cbrt(x); });
  EXPECT_LT(error, 1.01 * kHalfUlp);
}

TEST(VectorMath, CubeRootsOfCubesAreExact) {
  for (const float root : {1.0F, 2.0F, 3.0F, 0.5F, 0.25F, 10.0F}) {
    EXPECT_EQ(metrics::cube_root(root * root * root), root);
  }
}

TEST(VectorMath, LogarithmOfPowersOfTwoIsExact) {
  for (int exponent = -120; exponent <= 120; ++exponent) {
    EXPECT_EQ(metrics::log2_of(std::ldexp(1.0F, exponent)), static_cast<float>(exponent));
  }
}

TEST(VectorMath, LogarithmIsCloseEverywhere) {
  for (float x = 1e-30F; x < 1e30F; x *= 1.0007F) {
    const double exact = std::log2(static_cast<double>(x));
    EXPECT_NEAR(metrics::log2_of(x), exact, 2e-7 * (1.0 + std::abs(exact)));
  }
}

TEST(VectorMath, PowerOfTwoIsCloseAndNeverUnderflows) {
  for (float x = -125.0F; x < 126.0F; x += 0.01F) {
    EXPECT_NEAR(metrics::exp2_of(x) / std::exp2(static_cast<double>(x)), 1.0, 3e-7);
  }
  EXPECT_EQ(metrics::exp2_of(-1000.0F), 0x1p-126F);
}

TEST(VectorMath, PowerIsClose) {
  for (const float power : {0.7F, 0.5F, 1.0F, 2.4F}) {
    const double error = largest_relative_error(
        1e-6F, 300.0F, [&](float x) { return metrics::power_of(x, power); },
        [&](double x) { return std::pow(x, static_cast<double>(power)); });
    EXPECT_LT(error, 4e-6) << power;
  }
}

TEST(VectorMath, DecodesSrgbAsPerceptionDoes) {
  for (int code = 0; code <= 4095; ++code) {
    const float encoded = static_cast<float>(code) / 4095.0F;
    EXPECT_NEAR(metrics::srgb_to_linear(encoded), perception::srgb_decode(encoded), 3e-7F);
  }
}

}  // namespace
