#include "results/history/step_detection.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace test_results {
namespace {

using results::history::find_steps;
using results::history::Step;

/// Levels with multiplicative noise.
std::vector<double> series(const std::vector<std::pair<double, int>>& levels, double noise,
                           std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<double> values;
  for (const auto& [level, count] : levels) {
    for (int i = 0; i < count; ++i) values.push_back(level * std::exp(normal(random)));
  }
  return values;
}

TEST(Steps, FindsWhereALevelChanged) {
  const std::vector<Step> steps = find_steps(series({{1.0, 20}, {1.1, 20}}, 0.02, 1), 0.05);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_NEAR(static_cast<double>(steps[0].at), 20.0, 1.0);
  EXPECT_NEAR(steps[0].after / steps[0].before, 1.1, 0.02);
}

TEST(Steps, FindsSeveral) {
  const std::vector<Step> steps =
      find_steps(series({{1.0, 15}, {1.3, 15}, {0.9, 15}}, 0.03, 2), 0.05);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_NEAR(static_cast<double>(steps[0].at), 15.0, 1.0);
  EXPECT_NEAR(static_cast<double>(steps[1].at), 30.0, 1.0);
}

/// A noiseless series, as scores without random numbers are.
TEST(Steps, TakesNumbersWithoutNoise) {
  const std::vector<Step> steps = find_steps(std::vector{2.0, 2.0, 2.0, 3.0, 3.0}, 0.05);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].at, 3U);
  EXPECT_EQ(steps[0].before, 2.0);
  EXPECT_EQ(steps[0].after, 3.0);
  EXPECT_TRUE(find_steps(std::vector{2.0, 2.0, 2.0, 2.0, 2.0}, 0.05).empty());
  // Where values reach 0 the effect is absolute.
  EXPECT_EQ(find_steps(std::vector{0.0, 0.0, 0.0, 1.0, 1.0}, 0.05).size(), 1U);
}

TEST(Steps, AnOutlierIsNone) {
  std::vector<double> values = series({{1.0, 30}}, 0.01, 3);
  values[12] = 3.0;
  EXPECT_TRUE(find_steps(values, 0.05).empty());
  values[12] = 1.0;
  values.back() = 3.0;
  EXPECT_TRUE(find_steps(values, 0.05).empty());
}

TEST(Steps, LeavesNoiseAlone) {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    if (!find_steps(series({{1.0, 40}}, 0.05, 100 + seed), 0.05).empty()) ++alarms;
  }
  EXPECT_LE(alarms, 3);
}

TEST(Steps, ShortSeriesHaveNone) {
  EXPECT_TRUE(find_steps(std::vector{1.0, 5.0, 5.0}, 0.05).empty());
  EXPECT_TRUE(find_steps(std::vector<double>{}, 0.05).empty());
}

}  // namespace
}  // namespace test_results
