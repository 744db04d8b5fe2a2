#include "results/comparison/comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/comparison/comparison_output.h"
#include "tests/results/claims/claim_run.h"

namespace test_results {
namespace {

using namespace results::comparison;
using results::CellRecord;
using results::RunValues;
using results::Status;
using Values = std::vector<double>;
using Method = ClaimRun::Method;

Comparison compared(const ClaimRun& before, const ClaimRun& after, const Rules& rules = {}) {
  return compare(RunValues(before.run()), RunValues(after.run()), rules);
}

/// The one change of a quantity. @param method  "": any
Change change_of(const Comparison& comparison, const std::string& quantity,
                 const std::string& method = "") {
  const auto found = std::ranges::find_if(comparison.changes, [&](const Change& change) {
    return change.quantity == quantity && (method.empty() || change.method == method);
  });
  EXPECT_NE(found, comparison.changes.end()) << quantity << ' ' << method;
  return found == comparison.changes.end() ? Change{} : *found;
}

/// Times with noise of a share of themselves.
Values noisy(double seconds, std::size_t count, double share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, share);
  Values times(count);
  for (double& time : times) time = seconds * std::exp(normal(random));
  return times;
}

TEST(Compare, CatchesASlowdownAndNamesItsRow) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, noisy(1.0, 7, 0.01, 1));
  after.times({"pt"}, noisy(1.0, 7, 0.01, 2));
  before.times({"val"}, noisy(2.0, 7, 0.01, 3));
  after.times({"val"}, noisy(2.2, 7, 0.01, 4));
  const Comparison result = compared(before, after);
  EXPECT_EQ(change_of(result, "total_s", "pt").verdict, Verdict::same);
  const Change slower = change_of(result, "total_s", "val");
  EXPECT_EQ(slower.verdict, Verdict::worse);
  ASSERT_TRUE(slower.ratio);
  EXPECT_NEAR(slower.ratio->value, 1.1, 0.02);
  EXPECT_LE(*slower.q, 0.01);
  EXPECT_GE(*slower.q, *slower.p);
  ASSERT_FALSE(result.stages.empty());
  EXPECT_EQ(result.stages.front().method, "val");
  for (const Change& stage : result.stages) EXPECT_EQ(stage.method, "val");
  // The other way round it is an improvement.
  EXPECT_EQ(change_of(compared(after, before), "total_s", "val").verdict, Verdict::better);
}

TEST(Compare, OrdersStagesByHowMuchTheyMoved) {
  ClaimRun before;
  ClaimRun after;
  const auto stages = [](ClaimRun& run, const Values& gather, const Values& shadow) {
    for (std::size_t i = 0; i < gather.size(); ++i) {
      run.times({"val"}, {gather[i] + shadow[i]}).change([&](CellRecord& record) {
        record.repetition = static_cast<int>(i);
        record.render.stages.resize(2);
        record.render.stages[0].path = "shadow";
        record.render.stages[0].wall_s = shadow[i];
        record.render.stages[1].path = "gather";
        record.render.stages[1].wall_s = gather[i];
      });
    }
  };
  stages(before, noisy(1.0, 8, 0.01, 1), noisy(0.5, 8, 0.01, 2));
  stages(after, noisy(1.0, 8, 0.01, 3), noisy(0.8, 8, 0.01, 4));
  const Comparison result = compared(before, after);
  EXPECT_EQ(change_of(result, "total_s").verdict, Verdict::worse);
  ASSERT_EQ(result.stages.size(), 2U);
  EXPECT_EQ(result.stages[0].quantity, "shadow");
  EXPECT_EQ(result.stages[0].verdict, Verdict::worse);
  EXPECT_EQ(result.stages[1].quantity, "gather");
  EXPECT_EQ(result.stages[1].verdict, Verdict::same);
}

/// Nothing changed: over 10 pairs of nights with 20 rows each, at most one alarm per hundred rows.
TEST(Compare, RaisesNoFalseAlarms) {
  std::size_t alarms = 0;
  std::uint64_t seed = 1;
  for (int night = 0; night < 10; ++night) {
    ClaimRun before;
    ClaimRun after;
    for (int row = 0; row < 20; ++row) {
      const Method method{"m", "row", row};
      before.times(method, noisy(1.0, 6, 0.05, seed++));
      after.times(method, noisy(1.0, 6, 0.05, seed++));
    }
    const Comparison result = compared(before, after);
    alarms += result.count(Verdict::worse) + result.count(Verdict::better);
  }
  EXPECT_LE(alarms, 2U);
}

TEST(Compare, SaysWhatWouldTakeItToAVerdict) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, {1.0, 1.01, 0.99});
  after.times({"pt"}, {1.5, 1.51, 1.49});
  const Change few = change_of(compared(before, after), "total_s");
  EXPECT_EQ(few.verdict, Verdict::inconclusive);
  EXPECT_EQ(few.reason, "3 and 3 repetitions cannot show a change at alpha 0.01; 5 of each can");
  const Rules lenient{0.1, 0.05, 0.05};
  EXPECT_EQ(change_of(compared(before, after, lenient), "total_s").verdict, Verdict::worse);

  ClaimRun wide;
  wide.times({"pt"}, noisy(1.05, 8, 0.2, 5));
  ClaimRun base;
  base.times({"pt"}, noisy(1.0, 8, 0.2, 6));
  const Change unsure = change_of(compared(base, wide), "total_s");
  EXPECT_EQ(unsure.verdict, Verdict::inconclusive);
  EXPECT_EQ(unsure.reason, "may be a change of 5 % or none");
}

/// A change below the least effect is none, however clear.
TEST(Compare, AsksForALeastEffect) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, noisy(1.0, 12, 0.001, 1));
  after.times({"pt"}, noisy(1.02, 12, 0.001, 2));
  EXPECT_EQ(change_of(compared(before, after), "total_s").verdict, Verdict::same);
  const Rules strict{0.01, 0.01, 0.01};
  EXPECT_EQ(change_of(compared(before, after, strict), "total_s").verdict, Verdict::worse);
}

TEST(Compare, PairsScoresBySeed) {
  ClaimRun before;
  ClaimRun after;
  // Seeds differ by far more than the change: only pairs show it.
  before.scores({"pt"}, "relmse", {0.1, 0.2, 0.4, 0.8});
  after.scores({"pt"}, "relmse", {0.121, 0.241, 0.481, 0.961});
  const Change error = change_of(compared(before, after), "relmse");
  EXPECT_EQ(error.verdict, Verdict::worse);
  EXPECT_NEAR(error.ratio->value, 1.2, 0.01);

  ClaimRun other;
  other.scores({"pt"}, "relmse", {0.121, 0.17, 0.5, 0.7});
  EXPECT_EQ(change_of(compared(before, other), "relmse").verdict, Verdict::inconclusive);

  const Change equal = change_of(compared(before, before), "relmse");
  EXPECT_EQ(equal.verdict, Verdict::same);
  EXPECT_EQ(equal.reason, "equal");

  ClaimRun single;
  single.scores({"pt"}, "relmse", {0.1});
  ClaimRun worse;
  worse.scores({"pt"}, "relmse", {0.2});
  const Change one = change_of(compared(single, worse), "relmse");
  EXPECT_EQ(one.verdict, Verdict::inconclusive);
  EXPECT_EQ(one.reason, "one seed in common; two or more tell the noise of the estimator");
}

TEST(Compare, KnowsWhichWayScoresAreBetter) {
  ClaimRun before;
  ClaimRun after;
  before.scores({"pt"}, "psnr", {30.0, 31.0, 32.0});
  after.scores({"pt"}, "psnr", {36.0, 37.2, 38.4});
  for (ClaimRun* run : {&before, &after}) run->metric("psnr");
  const Change score = change_of(compared(before, after), "psnr");
  EXPECT_EQ(score.verdict, Verdict::better);
}

TEST(Compare, ScoresOfZeroHaveNoRatio) {
  ClaimRun before;
  ClaimRun after;
  before.scores({"pt"}, "mse", {0.0, 0.0, 0.0});
  after.scores({"pt"}, "mse", {0.1, 0.11, 0.1});
  const Change score = change_of(compared(before, after), "mse");
  EXPECT_EQ(score.verdict, Verdict::worse);
  EXPECT_FALSE(score.ratio);
}

TEST(Compare, AScoreThatWentMissingIsSaid) {
  ClaimRun before;
  ClaimRun after;
  before.scores({"pt"}, "flip", {0.1, 0.1});
  after.times({"pt"}, {1.0});
  const Change lost = change_of(compared(before, after), "flip");
  EXPECT_EQ(lost.verdict, Verdict::not_measured);
  EXPECT_EQ(lost.reason, "no finite score in the later run");
  EXPECT_EQ(change_of(compared(after, before), "flip").reason,
            "no finite score in the earlier run");
}

TEST(Compare, NewFailuresAreWorse) {
  ClaimRun before;
  ClaimRun after;
  before.times({"val"}, {1.0, 1.0});
  after.times({"val"}, {1.0}).change([](CellRecord& record) {
    record.render.status = Status::timeout;
  });
  const Change status = change_of(compared(before, after), "status");
  EXPECT_EQ(status.verdict, Verdict::worse);
  EXPECT_EQ(status.reason, "was 2 ok, is timeout");
  EXPECT_EQ(change_of(compared(after, before), "status").verdict, Verdict::better);
  EXPECT_EQ(change_of(compared(after, after), "status").verdict, Verdict::invalid);
}

TEST(Compare, WhatIsRefusedNowAndWasMeasuredIsWorse) {
  const auto with_status = [](Status status) {
    ClaimRun run;
    run.times({"val"}, {1.0}).change([=](CellRecord& record) { record.render.status = status; });
    return run;
  };
  ClaimRun before;
  before.times({"val"}, {1.0});
  const ClaimRun refused = with_status(Status::unsupported);
  EXPECT_EQ(change_of(compared(before, refused), "status").verdict, Verdict::worse);
  EXPECT_EQ(change_of(compared(refused, before), "status").verdict, Verdict::not_measured);
  EXPECT_EQ(change_of(compared(refused, refused), "status").verdict, Verdict::not_measured);
  EXPECT_EQ(change_of(compared(before, with_status(Status::skipped)), "status").verdict,
            Verdict::not_measured);
}

/// Machines are never mixed; scores do not depend on them.
TEST(Compare, RefusesWhatMayNotBeCompared) {
  ClaimRun before;
  before.scores({"pt"}, "relmse", {0.1, 0.2});
  ClaimRun after;
  after.scores({"pt"}, "relmse", {0.1, 0.2}).each_record([](CellRecord& record) {
    record.machine = "another";
  });
  const Comparison mixed = compared(before, after);
  EXPECT_EQ(change_of(mixed, "total_s").verdict, Verdict::invalid);
  EXPECT_NE(change_of(mixed, "total_s").reason.find("measured on another, before on"),
            std::string::npos);
  EXPECT_EQ(change_of(mixed, "relmse").verdict, Verdict::same);

  ClaimRun larger;
  larger.times({"pt"}, {1.0}).each_record([](CellRecord& record) { record.render.width_px = 999; });
  const Change size = change_of(compared(before, larger), "total_s");
  EXPECT_EQ(size.verdict, Verdict::invalid);
  EXPECT_EQ(size.reason.find("size was "), 0U);
}

TEST(Compare, SaysThatAMachineWasBusy) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, {1.0, 1.0}).environment({{"cores", 2}, {"load_average", {0.3, 3.0, 3.0}}});
  after.times({"pt"}, {1.0, 1.0}).environment({{"cores", 2}, {"load_average", {3.5, 0.1, 0.1}}});
  EXPECT_TRUE(compared(before, before).notes.empty());
  const Comparison result = compared(before, after);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_EQ(result.notes.front(),
            "the machine was busy when the later run began (load 3.5 on 2 cores): its times are "
            "those of other work as well");
}

TEST(Compare, ListsRowsOfOneRunAlone) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, {1.0});
  after.times({"val"}, {1.0});
  const Comparison result = compared(before, after);
  EXPECT_EQ(change_of(result, "total_s", "val").reason, "only in the later run");
  EXPECT_EQ(change_of(result, "total_s", "pt").reason, "only in the earlier run");
  EXPECT_EQ(result.count(Verdict::not_measured), 2U);
}

TEST(Compare, AveragesOverScenes) {
  ClaimRun before;
  ClaimRun after;
  for (const char* scene : {"box", "room"}) {
    before.times({"pt", "", 0, scene}, {1.0, 1.0});
  }
  after.times({"pt", "", 0, "box"}, {2.0, 2.0});
  after.times({"pt", "", 0, "room"}, {8.0, 8.0});
  const Comparison result = compared(before, after);
  ASSERT_EQ(result.overall.size(), 1U);
  EXPECT_DOUBLE_EQ(result.overall.front().ratio.value, 4.0);
  EXPECT_EQ(result.overall.front().ratio.count, 2U);
}

/// A night with other work on the machine: its slower canary says that it is not the method.
TEST(Compare, AsksTheCanaryBeforeItCallsAMethodSlower) {
  const auto with_canary = [](ClaimRun& run, double canary_s) {
    run.each_record([canary_s](CellRecord& record) { record.canary_s = canary_s; });
  };
  ClaimRun before;
  ClaimRun busy;
  before.times({"pt"}, noisy(1.0, 7, 0.01, 1));
  busy.times({"pt"}, noisy(1.3, 7, 0.01, 2));
  with_canary(before, 0.010);
  with_canary(busy, 0.013);
  const Comparison doubtful = compared(before, busy);
  const Change change = change_of(doubtful, "total_s");
  EXPECT_EQ(change.verdict, Verdict::inconclusive);
  EXPECT_EQ(change.reason, "the machine itself was 30 % slower here; --canary takes that out");
  ASSERT_EQ(doubtful.notes.size(), 1U);
  EXPECT_NE(doubtful.notes[0].find("canary: the machine was 30.0 % slower in the later run"),
            std::string::npos);

  Rules rules;
  rules.is_by_canary = true;
  const Change normalised = change_of(compared(before, busy, rules), "total_s");
  EXPECT_EQ(normalised.verdict, Verdict::same) << normalised.reason;
  EXPECT_NEAR(normalised.ratio->value, 1.0, 0.02);

  // A canary that sings as before leaves a slowdown what it is.
  ClaimRun slower;
  slower.times({"pt"}, noisy(1.3, 7, 0.01, 3));
  with_canary(slower, 0.010);
  EXPECT_EQ(change_of(compared(before, slower), "total_s").verdict, Verdict::worse);
  EXPECT_EQ(change_of(compared(before, slower, rules), "total_s").verdict, Verdict::worse);

  // A machine that slowed down explains no more than it did itself.
  ClaimRun both;
  both.times({"pt"}, noisy(3.0, 7, 0.01, 6));
  with_canary(both, 0.011);
  EXPECT_EQ(change_of(compared(before, both), "total_s").verdict, Verdict::worse);

  // One that slowed down hides no improvement.
  ClaimRun faster;
  faster.times({"pt"}, noisy(0.7, 7, 0.01, 4));
  with_canary(faster, 0.013);
  EXPECT_EQ(change_of(compared(before, faster), "total_s").verdict, Verdict::better);

  ClaimRun old;
  old.times({"pt"}, noisy(1.0, 7, 0.01, 5));
  EXPECT_EQ(change_of(compared(old, busy, rules), "total_s").verdict, Verdict::invalid);
}

/// Scores against another state of the reference, or of another version, tell nothing of a method.
TEST(Compare, ScoresMustBeOfTheSameKind) {
  const auto with = [](const std::function<void(results::MetricRecord&)>& what) {
    ClaimRun run;
    run.scores({"pt"}, "flip", {0.2, 0.21, 0.22});
    results::Run changed = run.run();
    for (results::MetricRecord& score : changed.metrics) what(score);
    return changed;
  };
  const results::Run before = with([](results::MetricRecord&) {});
  const auto change_to = [&](const std::function<void(results::MetricRecord&)>& what) {
    const results::Run after = with(what);
    return change_of(compare(RunValues(before), RunValues(after), {}), "flip");
  };
  EXPECT_EQ(change_to([](results::MetricRecord&) {}).verdict, Verdict::same);
  const Change extended =
      change_to([](results::MetricRecord& score) { score.reference_pixel_hash = "more samples"; });
  EXPECT_EQ(extended.verdict, Verdict::invalid);
  EXPECT_EQ(extended.reason,
            "the reference is another picture; `discern eval` scores the earlier run again");
  EXPECT_EQ(change_to([](results::MetricRecord& score) { ++score.version; }).verdict,
            Verdict::invalid);
  EXPECT_EQ(change_to([](results::MetricRecord& score) { score.viewing_hash = "far"; }).verdict,
            Verdict::invalid);
}

TEST(Compare, TablesAndJsonSayTheSame) {
  ClaimRun before;
  ClaimRun after;
  before.times({"val"}, noisy(2.0, 7, 0.01, 3));
  after.times({"val"}, noisy(2.4, 7, 0.01, 4));
  before.times({"pt"}, noisy(1.0, 7, 0.001, 5));
  after.times({"pt"}, noisy(1.0, 7, 0.001, 6));
  const Comparison result = compared(before, after);
  const results::Table all = change_table(result, false);
  EXPECT_EQ(all.rows.size(), 2U);
  const results::Table changed = change_table(result, true);
  ASSERT_EQ(changed.rows.size(), 1U);
  EXPECT_EQ(changed.rows[0][0].text, "- worse");
  EXPECT_EQ(changed.rows[0][2].text, "val");
  EXPECT_EQ(changed.notes.front(), "1 worse, 1 same");
  const nlohmann::ordered_json json = to_json(result);
  EXPECT_EQ(json.at("counts").at("worse"), 1);
  EXPECT_EQ(json.at("changes").size(), 2U);
  EXPECT_EQ(json.at("changes")[0].at("verdict"), "worse");
}

}  // namespace
}  // namespace test_results
