#include "metrics/flip_filters.h"

#include <gtest/gtest.h>

#include <numeric>

namespace {

using metrics::Kernel;

/// Resolution for which the authors' values are published: 0.7 m, 3840 px on 0.7 m.
constexpr double kPublishedPpd = 67.020645;

double sum_of(const Kernel<float>& kernel) {
  return std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0);
}

TEST(FlipFilters, RadiiAtThePublishedResolution) {
  const auto filters = metrics::make_flip_filters(kPublishedPpd);
  EXPECT_EQ(filters.achromatic.radius(), 10);
  EXPECT_EQ(filters.blue_yellow_wide.radius(), 10);
  EXPECT_EQ(filters.gaussian.radius(), 9);
  EXPECT_EQ(filters.largest_radius_px(), 10);
}

TEST(FlipFilters, KeepUniformAreas) {
  for (const double ppd : {5.0, 12.0, 30.0, kPublishedPpd, 200.0, 1000.0}) {
    const auto filters = metrics::make_flip_filters(ppd);
    EXPECT_NEAR(sum_of(filters.achromatic), 1.0, 1e-6) << ppd;
    EXPECT_NEAR(sum_of(filters.red_green), 1.0, 1e-6) << ppd;
    EXPECT_NEAR(sum_of(filters.gaussian), 1.0, 1e-6) << ppd;
    const double wide = sum_of(filters.blue_yellow_wide);
    const double narrow = sum_of(filters.blue_yellow_narrow);
    EXPECT_NEAR(wide * wide + narrow * narrow, 1.0, 1e-6) << ppd;
  }
}

TEST(FlipFilters, DerivativesAreBalanced) {
  for (const double ppd : {5.0, 12.0, 30.0, kPublishedPpd, 200.0}) {
    const auto filters = metrics::make_flip_filters(ppd);
    for (const Kernel<float>* kernel : {&filters.edge, &filters.point}) {
      double positive = 0.0;
      for (const float weight : kernel->weights) positive += weight > 0.0F ? double{weight} : 0.0;
      EXPECT_NEAR(positive, 1.0, 1e-6) << ppd;
      EXPECT_NEAR(sum_of(*kernel), 0.0, 1e-6) << ppd;
    }
  }
}

TEST(FlipFilters, EdgeIsOddAndPointIsEven) {
  const auto filters = metrics::make_flip_filters(kPublishedPpd);
  const std::size_t last = filters.edge.weights.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    EXPECT_FLOAT_EQ(filters.edge.weights[i], -filters.edge.weights[last - i]);
    EXPECT_FLOAT_EQ(filters.point.weights[i], filters.point.weights[last - i]);
  }
}

}  // namespace
