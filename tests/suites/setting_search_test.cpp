#include "suites/setting_search.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace {

using suites::SearchGoal;
using suites::SettingSearch;
using End = SettingSearch::End;

SettingSearch searched(const SearchGoal& goal, const std::function<double(double)>& law) {
  SettingSearch search(goal);
  while (const std::optional<double> setting = search.next()) search.add(law(*setting));
  return search;
}

SearchGoal goal_of(SearchGoal::Law law, double target) {
  SearchGoal goal;
  goal.law = law;
  goal.target = target;
  return goal;
}

TEST(SettingSearch, AnAffineTimeIsMetInAtMostFourProbes) {
  for (const double fixed_s : {0.0, 0.01, 0.3, 0.9}) {
    for (const double per_unit_s : {1e-4, 1e-3, 1e-2}) {
      const auto search = searched(goal_of(SearchGoal::Law::time, 1.0),
                                   [&](double n) { return fixed_s + per_unit_s * n; });
      EXPECT_EQ(search.end(), End::met) << fixed_s << " + " << per_unit_s << " n";
      EXPECT_NEAR(search.best().measured, 1.0, 0.05);
      EXPECT_LE(search.probes().size(), 4U) << fixed_s << " + " << per_unit_s << " n";
    }
  }
}

TEST(SettingSearch, NoProbeOfATimeCostsFarMoreThanTheTargetOrTheFirst) {
  const auto law = [](double n) { return 0.02 + 0.001 * n; };
  const auto search = searched(goal_of(SearchGoal::Law::time, 3.0), law);
  for (const suites::Probe& probe : search.probes()) {
    EXPECT_LE(probe.measured, 1.1 * 3.0);
  }
}

TEST(SettingSearch, APowerLawOfAnErrorIsMetInAtMostSixProbes) {
  for (const double exponent : {0.5, 1.0, 1.5}) {
    for (const double error_of_one : {0.5, 2.0}) {
      SearchGoal goal = goal_of(SearchGoal::Law::error, 0.02);
      goal.is_whole = false;
      const auto search =
          searched(goal, [&](double n) { return error_of_one * std::pow(n, -exponent); });
      EXPECT_EQ(search.end(), End::met) << exponent;
      EXPECT_NEAR(search.best().measured, 0.02, 0.05 * 0.02);
      EXPECT_LE(search.probes().size(), 6U) << exponent;
    }
  }
}

TEST(SettingSearch, AScoreThatRisesIsMet) {
  const auto search = searched(goal_of(SearchGoal::Law::score, 40.0),
                               [](double n) { return 20.0 + 10.0 * std::log10(n); });
  EXPECT_EQ(search.end(), End::met);
  EXPECT_NEAR(search.best().measured, 40.0, 2.0);
}

TEST(SettingSearch, NoiseOfAFewPercentDoesNotKeepItFromTheTarget) {
  double phase = 0.0;
  const auto search = searched(goal_of(SearchGoal::Law::time, 1.0), [&](double n) {
    phase += 2.4;  // noise of 3 %, the same on every machine
    return (0.1 + 0.002 * n) * (1.0 + 0.03 * std::sin(phase));
  });
  EXPECT_EQ(search.end(), End::met);
  EXPECT_NEAR(0.1 + 0.002 * search.best().setting, 1.0, 0.09);
}

TEST(SettingSearch, WholeSettingsGiveTheNearestOne) {
  // 3 gives 0.9, 4 gives 1.2: nothing lies within 5 %.
  const auto search =
      searched(goal_of(SearchGoal::Law::time, 1.0), [](double n) { return 0.3 * n; });
  EXPECT_EQ(search.end(), End::nearest);
  EXPECT_EQ(search.best().setting, 3.0);
  EXPECT_LE(search.probes().size(), 8U);
  SearchGoal real = goal_of(SearchGoal::Law::time, 1.0);
  real.is_whole = false;
  EXPECT_EQ(searched(real, [](double n) { return 0.3 * n; }).end(), End::met);
}

TEST(SettingSearch, BoundsThatDoNotReachTheTargetAreSaid) {
  const auto slow = searched(goal_of(SearchGoal::Law::time, 1.0), [](double n) { return 2.0 + n; });
  EXPECT_EQ(slow.end(), End::below_reach);
  EXPECT_EQ(slow.best().setting, 1.0);
  SearchGoal narrow = goal_of(SearchGoal::Law::time, 1.0);
  narrow.to = 64.0;
  const auto fast = searched(narrow, [](double n) { return 1e-3 * n; });
  EXPECT_EQ(fast.end(), End::beyond_reach);
  EXPECT_EQ(fast.best().setting, 64.0);
  const auto good =
      searched(goal_of(SearchGoal::Law::error, 0.5), [](double n) { return 0.1 / n; });
  EXPECT_EQ(good.end(), End::below_reach);
}

TEST(SettingSearch, AnErrorThatStandsStillEndsAtTheBound) {
  const auto search = searched(goal_of(SearchGoal::Law::error, 0.01), [](double) { return 0.3; });
  EXPECT_EQ(search.end(), End::beyond_reach);
  EXPECT_LE(search.probes().size(), 8U);
}

TEST(SettingSearch, StaysWithinItsBoundsAndItsProbes) {
  SearchGoal goal = goal_of(SearchGoal::Law::error, 1e-6);
  goal.from = 20.0;
  goal.to = 1000.0;
  goal.max_probes = 3;
  const auto search = searched(goal, [](double n) { return 1.0 / std::sqrt(n); });
  EXPECT_LE(search.probes().size(), 3U);
  for (const suites::Probe& probe : search.probes()) {
    EXPECT_GE(probe.setting, 20.0);
    EXPECT_LE(probe.setting, 1000.0);
  }
}

}  // namespace
