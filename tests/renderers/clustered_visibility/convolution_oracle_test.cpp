#include "tests/renderers/clustered_visibility/convolution_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace test_clustered_visibility {
namespace {

constexpr double kPi = std::numbers::pi;

/// Largest S over [first, last], in steps of 1e-4 of it.
double largest_step(const ConvolutionSeries& series, double first, double last) {
  double largest = -1.0;
  for (int i = 0; i <= 10000; ++i) {
    largest = std::max(largest, series_step(series, first + (last - first) * i * 1e-4));
  }
  return largest;
}

/// Texels of many depths with uneven weights.
Kernel uneven_kernel() {
  Kernel kernel;
  for (int i = 0; i < 20; ++i) kernel.push_back({0.3 + 0.03 * i, (1.0 + i) / 210.0});
  return kernel;
}

TEST(ConvolutionSeriesOracle, SlopeIsTheDirichletKernel) {
  // S'(t) = 2 sum cos((2k - 1) pi t) = sin(2 K pi t) / sin(pi t), 2K at 0.
  constexpr double kStep = 1e-5;
  for (const int terms : {1, 2, 4, 8, 16}) {
    const ConvolutionSeries series{terms, 0.0};
    const auto slope = [&](double t) {
      return (series_step(series, t + kStep) - series_step(series, t - kStep)) / (2.0 * kStep);
    };
    EXPECT_NEAR(slope(0.0), 2.0 * terms, 1e-5 * terms);
    for (const double t : {-0.7, -0.13, 0.04, 0.35}) {
      EXPECT_NEAR(slope(t), std::sin(2.0 * terms * kPi * t) / std::sin(kPi * t), 1e-5 * terms);
    }
    // So the first undershoot is at -1 / (2K).
    EXPECT_NEAR(slope(-series_offset(series)), 0.0, 1e-5 * terms);
  }
}

TEST(ConvolutionSeriesOracle, SymmetriesOfASquareWave) {
  const ConvolutionSeries series{4, 0.5};
  EXPECT_EQ(series_step(series, 0.0), 0.5);
  for (const double t : {0.03, 0.2, 0.55, 0.97}) {
    EXPECT_NEAR(series_step(series, t) + series_step(series, -t), 1.0, 1e-14);
    EXPECT_NEAR(series_step(series, 1.0 - t), series_step(series, t), 1e-14);
    EXPECT_NEAR(series_step(series, t - 2.0), series_step(series, t), 1e-13);
  }
  EXPECT_NEAR(series_step({2000, 0.0}, 0.3), 1.0, 1e-3);
  EXPECT_NEAR(series_step({2000, 0.0}, -0.3), 0.0, 1e-3);
}

TEST(ConvolutionSeriesOracle, DampingFadesTheHighTerms) {
  const ConvolutionSeries series{4, 1.0};
  EXPECT_DOUBLE_EQ(series_damping(series, 4), std::exp(-1.0));
  EXPECT_DOUBLE_EQ(series_damping(series, 2), std::exp(-0.25));
  EXPECT_EQ(series_damping({4, 0.0}, 4), 1.0);
  EXPECT_DOUBLE_EQ(series_frequency(1), kPi);
  EXPECT_DOUBLE_EQ(series_frequency(3), 5.0 * kPi);
}

TEST(ConvolutionSeriesOracle, OvershootAndLightLeft) {
  struct Row {
    int terms;
    double damping, overshoot, left_005, left_010, left_015;
  };
  constexpr Row kRows[] = {
      {4, 0.0, 0.092, 0.27, 0.108, 0.108},   {4, 0.5, 0.025, 0.40, 0.077, 0.077},
      {4, 1.0, 0.000, 0.50, 0.164, 0.071},   {8, 0.0, 0.090, 0.100, 0.100, 0.056},
      {8, 1.0, 0.004, 0.118, 0.046, 0.032},  {16, 0.0, 0.090, 0.098, 0.051, 0.036},
      {16, 1.0, 0.013, 0.038, 0.022, 0.015},
  };
  for (const Row& row : kRows) {
    SCOPED_TRACE("K " + std::to_string(row.terms) + ", a " + std::to_string(row.damping));
    const ConvolutionSeries series{row.terms, row.damping};
    EXPECT_NEAR(std::max(0.0, largest_step(series, 0.0, 1.0) - 1.0), row.overshoot, 0.001);
    // Gaps from g to 1 - g: nearer to 1 the wave returns.
    const auto light_left = [&](double gap) { return 2.0 * largest_step(series, gap - 1.0, -gap); };
    EXPECT_NEAR(light_left(0.05), row.left_005, 0.005);
    EXPECT_NEAR(light_left(0.10), row.left_010, 0.001);
    EXPECT_NEAR(light_left(0.15), row.left_015, 0.001);
  }
}

TEST(ConvolutionSeriesOracle, FirstZeroWithoutDamping) {
  const auto first_zero = [](int terms) {
    double t = 0.0;
    while (series_step({terms, 0.0}, -t) > 0.0) t += 1e-5;
    return t;
  };
  EXPECT_NEAR(first_zero(4), 0.076, 5e-4);
  EXPECT_NEAR(first_zero(8), 0.038, 5e-4);
  EXPECT_NEAR(first_zero(16), 0.019, 5e-4);
}

TEST(ConvolutionSeriesOracle, FullRangeComesBackToLight) {
  const ConvolutionSeries series{4, 0.0};
  EXPECT_NEAR(fixed_step(series, StepFix::scale, -0.95), 0.27, 0.005);
  EXPECT_NEAR(fixed_step(series, StepFix::scale, -0.98), 0.68, 0.005);
  EXPECT_LT(fixed_step(series, StepFix::scale, -0.90), 0.11) << "within the range it does not";
}

TEST(ConvolutionSeriesOracle, FixesMakeLitSurfacesWhite) {
  for (const int terms : {4, 8, 16}) {
    const ConvolutionSeries series{terms, 0.5};
    EXPECT_EQ(fixed_step(series, StepFix::scale, 0.0), 1.0);
    EXPECT_EQ(fixed_step(series, StepFix::offset, 0.0), 1.0);
    EXPECT_EQ(fixed_step(series, StepFix::offset, -series_offset(series)), 0.5);
  }
  // The offset eats the gap.
  EXPECT_NEAR(fixed_step({4, 0.0}, StepFix::offset, -0.15), 0.30, 0.005);
  EXPECT_LT(fixed_step({4, 0.0}, StepFix::offset, -0.25), 0.1);
  EXPECT_EQ(fixed_step({4, 0.0}, StepFix::scale, -0.125), 0.0) << "undershoot is clamped";
}

TEST(ConvolutionFilterOracle, FilterThenCompareIsTheMeanOfComparisons) {
  const Kernel kernel = uneven_kernel();
  for (const ConvolutionSeries series : {ConvolutionSeries{4, 0.5}, ConvolutionSeries{16, 0.0}}) {
    const BasisMeans means = basis_means(series, kernel);
    for (const double d : {0.25, 0.5, 0.8}) {
      double step = 0.0;
      double blocked_z = 0.0;
      for (const KernelTexel& texel : kernel) {
        const double own = series_step(series, texel.z - d);
        step += texel.weight * own;
        blocked_z += texel.weight * (1.0 - own) * texel.z;
      }
      EXPECT_NEAR(filtered_step(series, means, d), step, 1e-14);
      EXPECT_NEAR(blocker_sums(series, means, d).numerator, blocked_z, 1e-14);
      EXPECT_NEAR(blocker_sums(series, means, d).denominator, 1.0 - step, 1e-14);
      EXPECT_NEAR(filtered_visibility(series, means, d, StepFix::scale),
                  std::clamp(2.0 * step, 0.0, 1.0), 1e-14);
    }
  }
}

TEST(ConvolutionFilterOracle, OneTexelIsTheStep) {
  const ConvolutionSeries series{8, 0.5};
  for (const StepFix fix : {StepFix::scale, StepFix::offset}) {
    const BasisMeans means = basis_means(series, {{0.5, 1.0}});
    for (const double d : {0.45, 0.53, 0.56}) {
      EXPECT_NEAR(filtered_visibility(series, means, d, fix), fixed_step(series, fix, 0.5 - d),
                  1e-13);
    }
  }
}

TEST(ConvolutionFilterOracle, ScaleFailsBeforeAFarBackground) {
  // Half of the kernel blocked, the rest far: half of the light arrives.
  const ConvolutionSeries series{16, 0.5};
  const BasisMeans far = basis_means(series, two_plane_kernel({0.5, 0.2, 0.9}));
  EXPECT_NEAR(filtered_visibility(series, far, 0.55, StepFix::scale), 1.0, 0.02);
  EXPECT_NEAR(filtered_visibility(series, far, 0.55, StepFix::offset), 0.5, 0.02);
  const BasisMeans floor = basis_means(series, two_plane_kernel({0.5, 0.2, 0.55}));
  EXPECT_NEAR(filtered_visibility(series, floor, 0.55, StepFix::scale), 0.5, 0.02);
}

TEST(BlockerDepthOracle, RawAverageMakesKernelsTooSmall) {
  constexpr double kDistance = 0.8;
  const auto share = [](double blocked_fraction) {
    const double z = two_plane_raw_depth(blocked_fraction, 0.5 * kDistance, kDistance);
    return penumbra_width(kDistance, z, 1.0) / penumbra_width(kDistance, 0.5 * kDistance, 1.0);
  };
  EXPECT_NEAR(share(0.3), 0.30, 0.001);
  EXPECT_NEAR(share(0.5), 0.50, 0.001);
  EXPECT_NEAR(share(1.0), 1.00, 0.001);
  // A series of many terms agrees with the ideal step.
  const ConvolutionSeries series{200, 0.0};
  const TwoPlanes planes{0.3, 0.5 * kDistance, kDistance};
  const BasisMeans means = basis_means(series, two_plane_kernel(planes));
  EXPECT_NEAR(raw_blocker_depth(blocker_sums(series, means, kDistance)),
              two_plane_raw_depth(0.3, 0.5 * kDistance, kDistance), 1e-3);
}

TEST(BlockerDepthOracle, SumsOfTwoPlanes) {
  for (const ConvolutionSeries series : {ConvolutionSeries{4, 0.5}, ConvolutionSeries{8, 0.0}}) {
    for (const TwoPlanes planes : {TwoPlanes{0.3, 0.4, 0.8}, TwoPlanes{0.6, 0.2, 0.9}}) {
      const BasisMeans means = basis_means(series, two_plane_kernel(planes));
      const BlockerSums sums = blocker_sums(series, means, 0.8);
      const BlockerSums expected = two_plane_sums(series, planes, 0.8);
      EXPECT_NEAR(sums.numerator, expected.numerator, 1e-14);
      EXPECT_NEAR(sums.denominator, expected.denominator, 1e-14);
    }
  }
}

TEST(BlockerDepthOracle, ScaleCorrectionFindsTheBlockerWhateverTheFraction) {
  for (const ConvolutionSeries series :
       {ConvolutionSeries{4, 0.0}, ConvolutionSeries{4, 0.5}, ConvolutionSeries{8, 0.5}}) {
    for (const double blocked_fraction : {0.1, 0.3, 0.5, 0.9}) {
      const Kernel kernel = two_plane_kernel({blocked_fraction, 0.4, 0.8});
      const auto z =
          corrected_blocker_depth(series, basis_means(series, kernel), 0.8, StepFix::scale);
      ASSERT_TRUE(z.has_value());
      EXPECT_NEAR(*z, two_plane_scale_depth(series, 0.4, 0.8), 1e-12);
      EXPECT_NEAR(*z, 0.4, 0.014) << "what the ripple of the series moves";
    }
  }
}

TEST(BlockerDepthOracle, ScaleCorrectionIsWrongBeforeAFarBackground) {
  // Ideal step: A = f z_b, B = f, so z = (f z_b - (1 - f) d) / (2 f - 1).
  const ConvolutionSeries series{64, 0.5};
  const BasisMeans means = basis_means(series, two_plane_kernel({0.6, 0.25, 0.9}));
  const auto scale = corrected_blocker_depth(series, means, 0.5, StepFix::scale);
  const auto offset = corrected_blocker_depth(series, means, 0.5, StepFix::offset);
  ASSERT_TRUE(scale.has_value() && offset.has_value());
  EXPECT_NEAR(*scale, (0.6 * 0.25 - 0.4 * 0.5) / 0.2, 0.02);
  EXPECT_NEAR(*offset, 0.25, 0.02);
}

TEST(BlockerDepthOracle, OffsetIsBiasedWhereLittleIsBlocked) {
  // Unblocked texels at d weigh 1 - S(1 / (2K)) < 0.
  const ConvolutionSeries series{4, 0.5};
  const auto share = [&](double blocked_fraction) {
    const Kernel kernel = two_plane_kernel({blocked_fraction, 0.4, 0.8});
    return corrected_blocker_depth(series, basis_means(series, kernel), 0.8, StepFix::offset)
               .value() /
           0.4;
  };
  EXPECT_NEAR(share(0.1), 0.784, 0.001);
  EXPECT_NEAR(share(0.5), 0.980, 0.001);
  EXPECT_NEAR(share(1.0), 1.000, 1e-12);
}

TEST(BlockerDepthOracle, LittleBlockedIsLit) {
  const ConvolutionSeries series{64, 1.0};
  for (const StepFix fix : {StepFix::scale, StepFix::offset}) {
    const auto is_lit = [&](double blocked_fraction) {
      const Kernel kernel = two_plane_kernel({blocked_fraction, 0.4, 0.8});
      return !corrected_blocker_depth(series, basis_means(series, kernel), 0.8, fix).has_value();
    };
    EXPECT_TRUE(is_lit(0.0));
    EXPECT_TRUE(is_lit(0.04));
    EXPECT_FALSE(is_lit(0.07));
    EXPECT_FALSE(is_lit(1.0));
  }
}

}  // namespace
}  // namespace test_clustered_visibility
