#include "metrics/score_pooling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/metrics/metric_pictures.h"

namespace {

using perception::Encoding;
using perception::Image;

/// A map that holds every value (i + 1/2) / count once.
Image uniform_distribution(int side_px) {
  Image map = perception::make_gray_image(side_px, side_px, "error", Encoding::scene_linear);
  const auto count = static_cast<float>(map.pixels.size());
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    map.pixels[i] = (static_cast<float>(i) + 0.5F) / count;
  }
  return map;
}

TEST(ScorePooling, WeightedQuartilesOfAUniformDistribution) {
  // The weight below v is the integral of v, so quantile q lies at sqrt(q).
  const auto quartiles = metrics::weighted_quartiles(uniform_distribution(300), nullptr);
  EXPECT_NEAR(quartiles.first, std::sqrt(0.25), 1e-4);
  EXPECT_NEAR(quartiles.median, std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(quartiles.third, std::sqrt(0.75), 1e-4);
}

TEST(ScorePooling, WeightedQuartilesOfNothingAreZero) {
  const Image map = perception::make_gray_image(4, 4, "error", Encoding::scene_linear);
  EXPECT_EQ(metrics::weighted_quartiles(map, nullptr).median, 0.0);
}

TEST(ScorePooling, QuantileByNearestRank) {
  Image map = perception::make_gray_image(5, 2, "error", Encoding::scene_linear);
  map.pixels = {7.0F, 1.0F, 9.0F, 3.0F, 5.0F, 10.0F, 2.0F, 8.0F, 4.0F, 6.0F};
  EXPECT_EQ(metrics::masked_quantile(map, nullptr, 0.95), 10.0);
  EXPECT_EQ(metrics::masked_quantile(map, nullptr, 0.9), 9.0);
  EXPECT_EQ(metrics::masked_quantile(map, nullptr, 0.01), 1.0);
  const Image top = tests::mask_where(5, 2, [](int, int y) { return y == 0; });
  EXPECT_EQ(metrics::masked_quantile(map, &top, 0.5), 5.0);
}

TEST(ScorePooling, MaskedMeanDividesByTheMask) {
  const Image map = uniform_distribution(10);
  const Image mask = tests::mask_where(10, 10, [](int, int y) { return y == 0; });
  EXPECT_NEAR(metrics::masked_mean(map, nullptr), 0.5, 1e-7);
  EXPECT_NEAR(metrics::masked_mean(map, &mask), 0.05, 1e-8);
}

TEST(ScorePooling, TrimmingDropsTheLargestAndDividesByTheRest) {
  std::vector<float> errors{5.0F, 1.0F, 2.0F, 100.0F};
  EXPECT_DOUBLE_EQ(metrics::trimmed_mean(errors, 0.0), 27.0);
  EXPECT_DOUBLE_EQ(metrics::trimmed_mean(errors, 0.25), 8.0 / 3.0);
  EXPECT_DOUBLE_EQ(metrics::trimmed_mean(errors, 0.49), 8.0 / 3.0);
  EXPECT_DOUBLE_EQ(metrics::trimmed_mean(errors, 0.5), 1.5);
}

TEST(ScorePooling, ExtremesNameTheFirstLargestPixelInsideTheMask) {
  Image map = perception::make_gray_image(5, 4, "error", Encoding::scene_linear);
  map.at(3, 1) = 0.5F;
  map.at(2, 2) = 0.5F;
  map.at(4, 3) = 0.9F;
  const Image mask = tests::mask_where(5, 4, [](int x, int y) { return x != 4 && y > 0; });
  const auto extremes = metrics::map_extremes(map, &mask);
  EXPECT_EQ(extremes.minimum, 0.0);
  EXPECT_EQ(extremes.maximum, 0.5);
  EXPECT_EQ(extremes.max_x_px, 3);
  EXPECT_EQ(extremes.max_y_px, 1);
}

}  // namespace
