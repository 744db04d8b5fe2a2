#include "results/history/step_detection.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "perception/base/quantile.h"

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

/// Levels that are kept more evenly than a single value is known.
TEST(Steps, AreNoneWhereTheIntervalsOfTheLevelsMeet) {
  const auto steps_of = [](const std::vector<double>& values, double half) {
    std::vector<results::history::ValueInterval> intervals;
    for (const double value : values) {
      intervals.push_back({value * (1.0 - half), value * (1.0 + half)});
    }
    return find_steps(values, 0.05, intervals).size();
  };
  const std::vector<double> values = series({{1.0, 8}, {1.12, 8}}, 0.002, 5);
  EXPECT_EQ(steps_of(values, 0.01), 1U);
  EXPECT_EQ(steps_of(values, 0.1), 0U);
  // What goes on past a level that was none is measured from where it began.
  const std::vector<double> rises = series({{1.0, 8}, {1.12, 8}, {1.5, 8}}, 0.002, 6);
  EXPECT_EQ(steps_of(rises, 0.1), 1U);
}

TEST(Steps, AnOutlierIsNone) {
  std::vector<double> values = series({{1.0, 30}}, 0.01, 3);
  values[12] = 3.0;
  EXPECT_TRUE(find_steps(values, 0.05).empty());
  values[12] = 1.0;
  values.back() = 3.0;
  EXPECT_TRUE(find_steps(values, 0.05).empty());
}

double distances_from_median(std::vector<double> values) {
  std::ranges::sort(values);
  const double median = values[(values.size() - 1) / 2];
  double sum = 0.0;
  for (const double value : values) sum += std::fabs(value - median);
  return sum;
}

/// The least sum of distances and prices of all ways to cut y into levels of two values and more.
double least_cost(const std::vector<double>& y, double price) {
  std::vector<double> best(y.size() + 1, 1e300);
  best[0] = -price;
  for (std::size_t end = 2; end <= y.size(); ++end) {
    for (std::size_t begin = 0; begin + 2 <= end; ++begin) {
      const auto at = [&](std::size_t i) { return y.begin() + static_cast<std::ptrdiff_t>(i); };
      const double level = distances_from_median({at(begin), at(end)});
      best[end] = std::min(best[end], best[begin] + price + level);
    }
  }
  return best.back();
}

/// Of all levels the ones found are the best, by the definition, for long and short ones and with
/// values that repeat.
TEST(Steps, AreTheBestOfAllLevels) {
  std::mt19937_64 random(7);
  for (int n = 4; n < 90; ++n) {
    std::vector<double> values;
    double level = 1.0;
    for (int i = 0; i < n; ++i) {
      if (random() % 9 == 0) level = 1.0 + 0.5 * static_cast<double>(random() % 5);
      values.push_back(level + 0.01 * static_cast<double>(random() % 7));
    }
    std::vector<double> y;
    for (const double value : values) y.push_back(std::log(value));
    std::vector<double> differences;
    for (int i = 1; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      differences.push_back(std::fabs(y[at] - y[at - 1]));
    }
    const double b = std::max(base::median(differences) / 1.1462, 1e-9);
    const double price = 2.0 * b * std::log(static_cast<double>(n));
    std::vector<std::size_t> bounds{0};
    for (const Step& step : find_steps(values, 0.0)) bounds.push_back(step.at);
    bounds.push_back(y.size());
    double cost = -price;
    for (std::size_t i = 1; i < bounds.size(); ++i) {
      ASSERT_GE(bounds[i] - bounds[i - 1], 2U);
      const auto at = [&](std::size_t k) { return y.begin() + static_cast<std::ptrdiff_t>(k); };
      cost += price + distances_from_median({at(bounds[i - 1]), at(bounds[i])});
    }
    EXPECT_NEAR(cost, least_cost(y, price), 1e-12 * n) << n;
  }
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
