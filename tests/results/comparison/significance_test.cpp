#include "results/comparison/significance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace test_results {
namespace {

using namespace results::comparison;
using Values = std::vector<double>;

/// All deals of the values to the two series, by their mean ranks: no counting of sums.
double brute_force_p(const Values& a, const Values& b) {
  Values all = a;
  all.insert(all.end(), b.begin(), b.end());
  const auto rank = [&](double value) {
    double below = 0.0;
    double equal = 0.0;
    for (const double other : all) {
      below += other < value ? 1.0 : 0.0;
      equal += other == value ? 1.0 : 0.0;
    }
    return below + 0.5 * (equal + 1.0);
  };
  const double mean = 0.5 * static_cast<double>(a.size() * (all.size() + 1));
  double seen = 0.0;
  for (const double value : a) seen += rank(value);
  std::vector<int> deal(all.size(), 1);
  std::fill(deal.begin(), deal.begin() + static_cast<std::ptrdiff_t>(b.size()), 0);
  double count = 0.0;
  double extreme = 0.0;
  do {
    double sum = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) sum += deal[i] == 1 ? rank(all[i]) : 0.0;
    count += 1.0;
    extreme += std::fabs(sum - mean) >= std::fabs(seen - mean) - 1e-9 ? 1.0 : 0.0;
  } while (std::next_permutation(deal.begin(), deal.end()));
  return extreme / count;
}

TEST(RankSum, CountsAllDeals) {
  EXPECT_DOUBLE_EQ(rank_sum_p(Values{1, 2, 3}, Values{4, 5, 6}), 0.1);
  EXPECT_DOUBLE_EQ(rank_sum_p(Values{5, 6, 7, 8}, Values{1, 2, 3, 4}), 2.0 / 70.0);
  EXPECT_DOUBLE_EQ(rank_sum_p(Values{1}, Values{1, 1, 1}), 1.0);
  const Values a{0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
  const Values b{1.15, 0.88, 0.90, 0.74, 1.21};
  EXPECT_NEAR(rank_sum_p(a, b), brute_force_p(a, b), 1e-12);
  const Values ties{1, 1, 2, 2, 2, 5};
  const Values more{2, 3, 3, 5, 5};
  EXPECT_NEAR(rank_sum_p(ties, more), brute_force_p(ties, more), 1e-12);
  EXPECT_NEAR(rank_sum_p(more, ties), brute_force_p(ties, more), 1e-12);
}

TEST(RankSum, ApproximationMeetsTheExactValue) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Values a(30);
  Values b(30);
  for (double& value : a) value = normal(random);
  for (double& value : b) value = normal(random) + 0.5;
  const double exact = rank_sum_p(a, b);
  a.push_back(normal(random));  // one rank too many to be counted
  EXPECT_NEAR(rank_sum_p(a, b), exact, 0.3 * exact);
  EXPECT_LT(rank_sum_p(a, b), 0.5);
}

TEST(RankSum, SaysHowManyItTakes) {
  EXPECT_DOUBLE_EQ(least_rank_sum_p(3, 3), 0.1);
  EXPECT_DOUBLE_EQ(least_rank_sum_p(1, 1), 1.0);
  EXPECT_EQ(fewest_repetitions(0.05), 4U);
  EXPECT_EQ(fewest_repetitions(0.01), 5U);
}

/// Tables of Student's t: P(|T| > 4.303) = 0.05 for 2 degrees of freedom, 2.776 for 4.
TEST(StudentTests, HaveTheTabulatedProbabilities) {
  // Mean 1, standard error 1 / 4.303 of three differences.
  const double spread = std::sqrt(3.0) / 4.303;
  EXPECT_NEAR(paired_t_p(Values{1.0 - spread, 1.0, 1.0 + spread}), 0.05, 1e-4);
  EXPECT_DOUBLE_EQ(paired_t_p(Values{0.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(paired_t_p(Values{0.5, 0.5}), 0.0);
  EXPECT_DOUBLE_EQ(paired_t_p(Values{-1.0, 1.0}), 1.0);
  // Equal spreads of three each: 4 degrees of freedom, standard error s sqrt(2 / 3).
  const double s = 1.0 / (2.776 * std::sqrt(2.0 / 3.0));
  const auto of_logs = [](Values logs) {
    for (double& value : logs) value = std::exp(value);
    return logs;
  };
  EXPECT_NEAR(welch_log_p(of_logs({-s, 0.0, s}), of_logs({1.0 - s, 1.0, 1.0 + s})), 0.05, 1e-3);
  EXPECT_DOUBLE_EQ(welch_log_p(Values{2.0, 2.0}, Values{2.0, 2.0}), 1.0);
  EXPECT_DOUBLE_EQ(welch_log_p(Values{2.0, 2.0}, Values{3.0, 3.0}), 0.0);
}

/// Of many tests without a change a share of alpha is significant, no more; of their ranks less.
TEST(StudentTests, AreNoMoreSensitiveThanTheySay) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0.0, 0.03);
  constexpr int kTests = 4000;
  int welch = 0;
  int ranks = 0;
  for (int i = 0; i < kTests; ++i) {
    Values a(5);
    Values b(7);
    for (double& value : a) value = std::exp(normal(random));
    for (double& value : b) value = std::exp(normal(random));
    welch += welch_log_p(a, b) <= 0.05 ? 1 : 0;
    ranks += rank_sum_p(a, b) <= 0.05 ? 1 : 0;
  }
  EXPECT_LT(welch, 0.06 * kTests);
  EXPECT_GT(welch, 0.03 * kTests);
  EXPECT_LT(ranks, 0.055 * kTests);
}

/// Benjamini & Hochberg 1995, Sec. 4.1: of their 15 p-values four are significant at 0.05.
TEST(FalseDiscovery, FollowsTheStepUpProcedure) {
  const Values p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                 0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
  const Values q = adjusted_for_false_discovery(p);
  EXPECT_EQ(std::ranges::count_if(q, [](double value) { return value <= 0.05; }), 4);
  EXPECT_NEAR(q[0], 0.0015, 1e-12);
  EXPECT_NEAR(q[3], 0.0095 * 15.0 / 4.0, 1e-12);
  const Values reversed(p.rbegin(), p.rend());
  const Values same = adjusted_for_false_discovery(reversed);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(same[p.size() - 1 - i], q[i]);
  EXPECT_TRUE(adjusted_for_false_discovery({}).empty());
}

TEST(Ratios, HaveIntervals) {
  const results::Estimate few = ratio_of_medians(Values{1.0, 2.0, 3.0}, Values{4.0, 6.0, 5.0});
  EXPECT_DOUBLE_EQ(few.value, 2.5);
  EXPECT_DOUBLE_EQ(few.low, 4.0 / 3.0);
  EXPECT_DOUBLE_EQ(few.high, 6.0);
  Values a;
  Values b;
  for (int i = 0; i < 20; ++i) {
    a.push_back(1.0 + 0.01 * i);
    b.push_back(2.2 + 0.02 * i);
  }
  const results::Estimate many = ratio_of_medians(a, b);
  EXPECT_NEAR(many.value, 2.39 / 1.095, 1e-9);
  EXPECT_GT(many.low, 2.0);
  EXPECT_LT(many.high, 2.4);
  EXPECT_LT(many.low, many.value);
  EXPECT_GT(many.high, many.value);

  EXPECT_DOUBLE_EQ(geometric_mean(Values{2.0, 8.0}).value, 4.0);
  EXPECT_EQ(geometric_mean(Values{2.0, 8.0}).count, 2U);
  EXPECT_DOUBLE_EQ(geometric_mean(Values{3.0}).low, 3.0);
}

}  // namespace
}  // namespace test_results
