#include "metrics/threshold_search.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/expect_error.h"

namespace metrics {
namespace {

TEST(FindThreshold, BisectsTheLogarithm) {
  const auto power_law = [](double contrast) { return std::pow(contrast / 0.0123, 1.7); };
  const FoundThreshold found = find_threshold(power_law, 1.0, {});
  ASSERT_TRUE(found.contrast);
  EXPECT_NEAR(20.0 * std::log10(*found.contrast / 0.0123), 0.0, 0.05);
  EXPECT_LT(found.evaluations, 16);
  SearchRange fine;
  fine.precision_db = 1e-6;
  EXPECT_NEAR(*find_threshold(power_law, 1.0, fine).contrast, 0.0123, 1e-8);
}

TEST(FindThreshold, SaysWhenThereIsNoneInTheRange) {
  const FoundThreshold unseen = find_threshold([](double c) { return c; }, 2.0, {});
  EXPECT_FALSE(unseen.contrast);
  EXPECT_FALSE(unseen.is_below_range);
  EXPECT_EQ(unseen.evaluations, 1);
  const FoundThreshold always = find_threshold([](double) { return 3.0; }, 2.0, {});
  EXPECT_FALSE(always.contrast);
  EXPECT_TRUE(always.is_below_range);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(find_threshold([=](double) { return nan; }, 2.0, {}).contrast);
}

perception::StimulusPair pair_of(double contrast) {
  const perception::Stimulus patch = perception::gabor_stimulus({.frequency_cpd = 4.0}, 2.0);
  return {perception::stimulus_image(patch, 0.0, 100.0, 30.0),
          perception::stimulus_image(patch, contrast, 100.0, 30.0)};
}

ViewingConditions viewing_of_pair() {
  ViewingConditions viewing = perception::default_viewing_conditions();
  viewing.pixels_per_degree = 30.0;
  return viewing;
}

double response(const char* metric, const char* detail, double contrast) {
  return response_to(pair_of(contrast), {parse_metric_choice(metric, {}), detail},
                     viewing_of_pair());
}

TEST(ResponseTo, GrowsWithTheDifferenceWhicheverWayTheMetricIsBetter) {
  for (const char* metric : {"visible-difference", "cvvdp", "pu-ssim", "pu-psnr", "yee"}) {
    EXPECT_LE(response(metric, "", 0.01), response(metric, "", 0.1)) << metric;
    EXPECT_LT(response(metric, "", 0.001), response(metric, "", 0.9)) << metric;
  }
  EXPECT_EQ(response("cvvdp", "", 0.0), 0.0);
  EXPECT_GT(response("cvvdp", "", 0.1), 0.0);
}

TEST(ResponseTo, ReadsADetail) {
  const double half = response("visible-difference", "jnd_max", 0.002);
  EXPECT_NEAR(response("visible-difference", "jnd_max", 0.004) / half, 2.0, 0.01);
}

TEST(ResponseTo, NamesTheDetailsThereAre) {
  tests::expect_error_with<base::InputError>(
      [] { response("visible-difference", "jnd_maxx", 0.1); },
      {"unknown detail of visible-difference \"jnd_maxx\"; did you mean \"jnd_max\"?"});
}

}  // namespace
}  // namespace metrics
