#include "results/convergence.h"

#include <cmath>

#include <gtest/gtest.h>

namespace {

using results::ConvergenceCurve;
using results::Estimate;

/// error = c / time, a straight line in both logarithms.
ConvergenceCurve inverse_law(std::uint64_t seed, double c) {
  ConvergenceCurve curve;
  curve.seed = seed;
  for (const double time_s : {0.1, 0.4, 1.6, 6.4}) {
    curve.points.push_back({time_s * 100.0, time_s, c / time_s});
  }
  return curve;
}

TEST(Convergence, InterpolatesAPowerLawExactly) {
  const std::vector<ConvergenceCurve> curves{inverse_law(1, 0.05)};
  const std::optional<Estimate> error = results::score_at_time(curves, 1.0);
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->value, 0.05, 1e-12);
  const std::optional<Estimate> time_s = results::time_to_score(curves, 0.025, true);
  ASSERT_TRUE(time_s.has_value());
  EXPECT_NEAR(time_s->value, 2.0, 1e-12);
}

TEST(Convergence, SeedsGiveAnInterval) {
  const std::vector<ConvergenceCurve> curves{inverse_law(1, 0.05), inverse_law(2, 0.06),
                                             inverse_law(3, 0.04)};
  const std::optional<Estimate> error = results::score_at_time(curves, 1.0);
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->value, 0.05, 1e-12);
  EXPECT_LT(error->low, error->value);
  EXPECT_GT(error->high, error->value);
  EXPECT_EQ(error->count, 3U);
  const std::optional<Estimate> time_s = results::time_to_score(curves, 0.05, true);
  ASSERT_TRUE(time_s.has_value());
  EXPECT_NEAR(time_s->value, std::cbrt(1.0 * 1.2 * 0.8), 1e-12);
}

TEST(Convergence, NothingIsExtrapolated) {
  const std::vector<ConvergenceCurve> curves{inverse_law(1, 0.05)};
  EXPECT_FALSE(results::score_at_time(curves, 0.05).has_value());
  EXPECT_FALSE(results::score_at_time(curves, 7.0).has_value());
  EXPECT_FALSE(results::time_to_score(curves, 1e-6, true).has_value());
  // Better from the start: when it was reached is not known.
  EXPECT_FALSE(results::time_to_score(curves, 0.9, true).has_value());
  EXPECT_FALSE(results::score_at_time({}, 1.0).has_value());
}

TEST(Convergence, ScoresThatRiseAndScoresAtNoughtAreLinear) {
  ConvergenceCurve curve;
  curve.points = {{1, 1.0, 0.0}, {2, std::exp(1.0), 10.0}};
  const std::vector<ConvergenceCurve> curves{curve};
  EXPECT_NEAR(results::score_at_time(curves, std::exp(0.5))->value, 5.0, 1e-12);
  EXPECT_NEAR(results::time_to_score(curves, 2.5, false)->value, std::exp(0.25), 1e-12);
}

}  // namespace
