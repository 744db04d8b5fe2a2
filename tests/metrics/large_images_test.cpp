// Every metric on 8K images: 33 million pixels, one square of 512 x 512 that differs.
#include <gtest/gtest.h>

#include <cmath>

#include "metrics/metric_list.h"
#include "perception/base/names.h"
#include "perception/image.h"
#include "tests/metrics/feature_metrics.h"

namespace {

using perception::Encoding;
using perception::Image;

Image gray_8k(bool has_square) {
  Image image = perception::make_rgb_image(7680, 4320, Encoding::scene_linear);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const bool is_square = has_square && x >= 3000 && x < 3512 && y >= 2000 && y < 2512;
      const float stripes = ((x / 16) % 2 == 0) ? 0.4F : 0.5F;
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = is_square ? 0.7F : stripes;
    }
  }
  return image;
}

class LargeImages : public testing::TestWithParam<std::string> {};

TEST_P(LargeImages, HaveAScoreThatSeesTheSquare) {
  const Image reference = gray_8k(false);
  const Image test = gray_8k(true);
  const metrics::MetricChoice choice = metrics::parse_metric_choice(GetParam(), {});
  metrics::ScoreOptions options;
  options.with_map = false;
  const double value =
      metrics::score(choice, {reference, test}, perception::ViewingConditions{}, options).value;
  // The square is none of the features that these look for, and its surround has none.
  if (tests::judges_one_feature(GetParam()) && GetParam() != "edge-excess") {
    EXPECT_TRUE(value == choice.info->identical_value || std::isnan(value)) << value;
    return;
  }
  ASSERT_TRUE(std::isfinite(value));
  if (GetParam() == "threshold-ratio") {  // a median: 99 of 100 pixels stay
    EXPECT_EQ(value, choice.info->identical_value);
    return;
  }
  EXPECT_NE(value, choice.info->identical_value);
  // What counts pixels counts the square's: 0.79 % of the picture, and what its edges blur into.
  if (GetParam() == "visible-difference" || GetParam() == "daly-vdp") {
    constexpr double kShare = 512.0 * 512.0 / (7680.0 * 4320.0);
    EXPECT_GT(value, 0.4 * kShare);
    EXPECT_LT(value, 1.6 * kShare);
  }
}

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const auto& info : metrics::metric_list()) names.push_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(EveryMetric, LargeImages, testing::ValuesIn(metric_names()),
                         [](const auto& test) { return base::snake_case(test.param); });

}  // namespace
