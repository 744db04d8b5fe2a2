#include "tests/renderers/clustered_visibility/convolution_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"

namespace test_clustered_visibility {
namespace {

constexpr double kPi = std::numbers::pi;

/// Map with blockers in the left half.
DepthMap half_map(int size_px, double z_blocker, double z_background) {
  DepthMap map{size_px, {}};
  for (int i = 0; i < size_px * size_px; ++i) {
    map.z.push_back(2 * (i % size_px) < size_px ? z_blocker : z_background);
  }
  return map;
}

TEST(KernelWidthOracle, SearchAngleIsThatOfABlockerHalfway) {
  constexpr double kArea = 0.09;
  const double search = search_angle_rad(1.0, kArea, 1.0, 2.0);
  EXPECT_DOUBLE_EQ(search, kernel_angle_rad(2.0, 1.0, 0.3));
  EXPECT_LT(search, kernel_angle_rad(2.0, 0.5, 0.3)) << "too small near the light";
  EXPECT_DOUBLE_EQ(search_angle_rad(2.0, kArea, 1.0, 2.0), 2.0 * search);
  EXPECT_DOUBLE_EQ(search_angle_rad(1.0, kArea, 0.25, 2.0), search_angle_rad(1.0, kArea, 1.0, 4.0));
}

TEST(KernelWidthOracle, PenumbraByHand) {
  // Intercept theorem: blocker at 1/4 of the way, three light sizes at the receiver.
  EXPECT_DOUBLE_EQ(penumbra_width(4.0, 1.0, 0.5), 1.5);
  EXPECT_DOUBLE_EQ(kernel_angle_rad(4.0, 1.0, 0.5), std::atan(0.375));
  EXPECT_EQ(kernel_angle_rad(4.0, 4.0, 0.5), 0.0) << "contact";
}

TEST(KernelWidthOracle, PaperWidthIsRightAtOneAngleOnly) {
  constexpr double kAngle = 1e-3;
  const auto ratio = [](double polar_rad) {
    return exact_kernel_width_uv(kAngle, polar_rad) / paper_kernel_width_uv(kAngle);
  };
  EXPECT_NEAR(ratio(0.0), 0.785, 0.001);
  EXPECT_NEAR(ratio(kPi / 3.0), 1.047, 0.001);
  EXPECT_NEAR(ratio(0.5 * kPi), 1.571, 0.001);
  EXPECT_NEAR(ratio(55.2 * kPi / 180.0), 1.0, 0.002);
  for (const double polar_rad : {0.0, 0.8, 1.5}) {
    const double radius = std::tan(0.5 * polar_rad);
    EXPECT_NEAR(
        conformal_kernel_width_uv(kAngle, radius) / exact_kernel_width_uv(kAngle, polar_rad), 1.0,
        1e-5);
  }
}

TEST(KernelWidthOracle, ExactWidthIsThatOfTheProjection) {
  const auto radius = [](double polar_rad) {
    const glm::dvec3 direction(std::sin(polar_rad), 0.0, std::cos(polar_rad));
    return renderers::shadow_maps::hemisphere_position(direction).x;
  };
  // The map's disc of radius 1 is half of uv wide.
  EXPECT_NEAR(exact_kernel_width_uv(0.6, 1.0), 0.5 * (radius(1.3) - radius(0.7)), 1e-15);
  EXPECT_NEAR(exact_kernel_width_uv(kPi, 0.0), 1.0, 1e-15) << "the whole map";
}

TEST(BoxKernelOracle, WeighsTexelsByCoverage) {
  const DepthMap map{2, {1.0, 2.0, 4.0, 8.0}};
  const auto mean = [&](const glm::dvec2& center, double width) {
    double sum = 0.0;
    double weights = 0.0;
    for (const KernelTexel& texel : box_kernel(map, center, width)) {
      sum += texel.weight * texel.z;
      weights += texel.weight;
    }
    EXPECT_NEAR(weights, 1.0, 1e-15);
    return sum;
  };
  EXPECT_DOUBLE_EQ(mean({0.25, 0.25}, 0.5), 1.0) << "one texel";
  EXPECT_DOUBLE_EQ(mean({0.75, 0.25}, 0.1), 2.0) << "less than one";
  EXPECT_DOUBLE_EQ(mean({0.5, 0.5}, 1.0), 15.0 / 4.0);
  // 3/4 of the width left, 1/4 right; all above.
  EXPECT_DOUBLE_EQ(mean({0.4, 0.25}, 0.4), 0.75 * 1.0 + 0.25 * 2.0);
  EXPECT_DOUBLE_EQ(mean({0.25, 0.4}, 0.4), 0.75 * 1.0 + 0.25 * 4.0);
  EXPECT_DOUBLE_EQ(mean({1.0, 1.0}, 0.5), 8.0) << "what lies outside does not count";
  EXPECT_DOUBLE_EQ(mean({0.5, 0.5}, 9.0), 15.0 / 4.0);
}

TEST(BoxKernelOracle, HalfPlaneGivesALinearRamp) {
  const DepthMap map = half_map(64, 0.4, 0.8);
  constexpr double kWidth = 0.25;
  for (const double u : {0.3, 0.4, 0.4375, 0.51, 0.6, 0.7}) {
    const Kernel kernel = box_kernel(map, {u, 0.5}, kWidth);
    const double lit = std::clamp(0.5 + (u - 0.5) / kWidth, 0.0, 1.0);
    EXPECT_NEAR(exact_visibility(kernel, 0.8), lit, 1e-12) << "d <= z is lit";
    EXPECT_NEAR(exact_visibility(kernel, 0.8001), 0.0, 1e-12);
    EXPECT_EQ(exact_blocker_depth(kernel, 0.8).has_value(), lit < 1.0);
    if (lit < 1.0) {
      EXPECT_NEAR(*exact_blocker_depth(kernel, 0.8), 0.4, 1e-12);
    }
  }
}

TEST(BoxKernelOracle, SeriesOfManyTermsApproachesBruteForce) {
  const ConvolutionSeries series{400, 0.5};
  const DepthMap map = half_map(16, 0.3, 0.85);
  const Kernel kernel = box_kernel(map, {0.45, 0.3}, 0.37);
  const BasisMeans means = basis_means(series, kernel);
  EXPECT_NEAR(filtered_visibility(series, means, 0.6, StepFix::offset),
              exact_visibility(kernel, 0.6), 2e-3);
  const auto z = corrected_blocker_depth(series, means, 0.6, StepFix::offset);
  ASSERT_TRUE(z.has_value());
  EXPECT_NEAR(*z, *exact_blocker_depth(kernel, 0.6), 2e-3);
}

}  // namespace
}  // namespace test_clustered_visibility
