#include "results/statistics.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace {

using results::Estimate;
using results::mean_with_interval;
using results::median_with_interval;
using results::student_t_half_width;

struct TableEntry {
  int degrees_of_freedom;
  double half_width_95;
  double half_width_99;
};

// Two-sided quantiles as printed in every table of Student's t, three decimals.
constexpr TableEntry kStudentTable[] = {{1, 12.706, 63.657}, {2, 4.303, 9.925},  {3, 3.182, 5.841},
                                        {4, 2.776, 4.604},   {5, 2.571, 4.032},  {9, 2.262, 3.250},
                                        {10, 2.228, 3.169},  {20, 2.086, 2.845}, {30, 2.042, 2.750},
                                        {60, 2.000, 2.660},  {120, 1.980, 2.617}};

TEST(StudentT, AgreesWithPrintedTables) {
  for (const TableEntry& entry : kStudentTable) {
    EXPECT_NEAR(student_t_half_width(0.95, entry.degrees_of_freedom), entry.half_width_95, 5e-4)
        << entry.degrees_of_freedom;
    EXPECT_NEAR(student_t_half_width(0.99, entry.degrees_of_freedom), entry.half_width_99, 5e-4)
        << entry.degrees_of_freedom;
  }
}

TEST(StudentT, HasClosedFormsForOneAndTwoDegrees) {
  // One degree is the Cauchy distribution: tan(pi c / 2); two: c sqrt(2 / (1 - c^2)).
  const double c = 0.8;
  EXPECT_NEAR(student_t_half_width(c, 1), std::tan(0.5 * M_PI * c), 1e-12);
  EXPECT_NEAR(student_t_half_width(c, 2), c * std::sqrt(2.0 / (1.0 - c * c)), 1e-12);
}

TEST(StudentT, TendsToTheNormalDistribution) {
  EXPECT_NEAR(student_t_half_width(0.95, 100001), 1.959988, 1e-4);
  EXPECT_NEAR(student_t_half_width(0.95, 100000), 1.959988, 1e-4);
}

TEST(MeanWithInterval, KnownNumbers) {
  // Mean 3, standard deviation sqrt(2.5), standard error sqrt(0.5), t(0.95, 4) = 2.7764.
  const std::vector<double> values{1, 2, 3, 4, 5};
  const Estimate mean = mean_with_interval(values);
  EXPECT_DOUBLE_EQ(mean.value, 3.0);
  EXPECT_NEAR(mean.high, 3.0 + 2.776445 * std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(mean.low, 3.0 - 2.776445 * std::sqrt(0.5), 1e-6);
  EXPECT_EQ(mean.count, 5U);
}

TEST(Intervals, OneValueHasNone) {
  const std::vector<double> one{0.25};
  for (const Estimate& estimate : {mean_with_interval(one), median_with_interval(one)}) {
    EXPECT_EQ(estimate.value, 0.25);
    EXPECT_EQ(estimate.low, 0.25);
    EXPECT_EQ(estimate.high, 0.25);
    EXPECT_EQ(estimate.count, 1U);
  }
}

TEST(MedianWithInterval, LiesBetweenValuesAndIsRepeatable) {
  const std::vector<double> values{5, 1, 4, 2, 30, 3, 8};
  const Estimate a = median_with_interval(values);
  const Estimate b = median_with_interval(values);
  EXPECT_EQ(a.value, 4.0);
  EXPECT_GE(a.low, 1.0);
  EXPECT_LE(a.high, 30.0);
  EXPECT_LE(a.low, a.value);
  EXPECT_GE(a.high, a.value);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
}

TEST(MedianWithInterval, ApproachesTheExactBootstrapOfSevenValues) {
  // Of seven draws out of {0 ... 6} the median is at most k - 1 if at least four draws are, with
  // probability P(B(7, k / 7) >= 4): 0.0102, 0.1083, 0.3469 for k = 1, 2, 3.
  const std::vector<double> values{3, 0, 6, 1, 5, 2, 4};
  EXPECT_EQ(median_with_interval(values, 1, 20000, 0.9).low, 1.0);
  EXPECT_EQ(median_with_interval(values, 1, 20000, 0.9).high, 5.0);
  EXPECT_EQ(median_with_interval(values, 1, 20000, 0.6).low, 2.0);
  EXPECT_EQ(median_with_interval(values, 1, 20000, 0.6).high, 4.0);
}

TEST(MedianWithInterval, FewValuesHaveTheirRange) {
  const Estimate five = median_with_interval(std::vector<double>{5, 1, 4, 2, 30});
  EXPECT_EQ(five.low, 1.0);
  EXPECT_EQ(five.high, 30.0);
  EXPECT_EQ(five.value, 4.0);
}

/// Share of simulated samples whose interval holds the truth.
template <class Draw, class Interval>
double coverage(double truth, const Draw& draw, const Interval& interval) {
  constexpr int kTrials = 1500;
  int hits = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(20);
    for (double& value : values) value = draw();
    const Estimate estimate = interval(values);
    hits += estimate.low <= truth && truth <= estimate.high ? 1 : 0;
  }
  return static_cast<double>(hits) / kTrials;
}

// 1500 trials: the standard error of a coverage of 0.95 is 0.006. Percentile intervals of a median
// are a little short in small samples.
TEST(Intervals, CoverTheTruthAsOftenAsTheySay) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(10.0, 2.0);
  std::lognormal_distribution<double> skewed(0.0, 1.0);  // median 1
  const double of_mean = coverage(
      10.0, [&] { return normal(random); },
      [](const std::vector<double>& v) { return mean_with_interval(v); });
  const double of_median = coverage(
      1.0, [&] { return skewed(random); },
      [](const std::vector<double>& v) { return median_with_interval(v, 1, 300); });
  EXPECT_NEAR(of_mean, 0.95, 0.02);
  EXPECT_NEAR(of_median, 0.94, 0.025);
}

TEST(Intervals, LessConfidenceCoversLess) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const double half = coverage(
      0.0, [&] { return normal(random); },
      [](const std::vector<double>& v) { return mean_with_interval(v, 0.5); });
  EXPECT_NEAR(half, 0.5, 0.07);
}

TEST(LeastSquaresLine, HasTheNormalEquationsSolution) {
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0};
  const std::vector<double> y{1.0, 3.0, 2.0, 5.0};
  // Sums: n = 4, x 6, y 11, xx 14, xy 22: slope (4 22 - 6 11) / (4 14 - 36) = 1.1.
  const auto line = results::least_squares_line(x, y);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->slope, 1.1, 1e-12);
  EXPECT_NEAR(line->intercept, 1.1, 1e-12);
  EXPECT_FALSE(
      results::least_squares_line(std::vector<double>{2.0, 2.0}, std::vector<double>{1.0, 2.0}));
}

TEST(RankCorrelation, FollowsOrderNotDistance) {
  const std::vector<double> x{1.0, 2.0, 3.0, 4.0, 5.0};
  EXPECT_NEAR(*results::rank_correlation(x, std::vector<double>{1.0, 10.0, 11.0, 500.0, 501.0}),
              1.0, 1e-12);
  EXPECT_NEAR(*results::rank_correlation(x, std::vector<double>{5.0, 4.0, 3.0, 2.0, -9.0}), -1.0,
              1e-12);
  // Without ties 1 - 6 sum d^2 / (n (n^2 - 1)): d = 0 0 0 1 1, 1 - 12 / 120.
  EXPECT_NEAR(*results::rank_correlation(x, std::vector<double>{1.0, 2.0, 3.0, 5.0, 4.0}), 0.9,
              1e-12);
  // Ranks 1.5 1.5 3 against 1 2 3: Pearson 1.5 / sqrt(1.5 x 2).
  EXPECT_NEAR(*results::rank_correlation(std::vector<double>{4.0, 4.0, 6.0},
                                         std::vector<double>{1.0, 2.0, 3.0}),
              1.5 / std::sqrt(3.0), 1e-12);
  EXPECT_FALSE(results::rank_correlation(x, std::vector<double>(5, 1.0)));
}

}  // namespace
