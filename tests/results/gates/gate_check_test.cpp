#include "results/gates/gate_check.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/gates/baseline.h"
#include "results/gates/junit.h"
#include "tests/results/claims/claim_run.h"

namespace test_results {
namespace {

using namespace results::gates;
using results::CellRecord;
using results::RunValues;
using Values = std::vector<double>;

std::vector<Gate> gates_of(const std::string& text) {
  return read_gates(base::parse_document(text, "suite.yaml"));
}

GateReport checked(const std::string& gates, const ClaimRun& before, const ClaimRun& after) {
  const RunValues earlier(before.run());
  return check_gates(gates_of(gates), &earlier, RunValues(after.run()), "");
}

Values noisy(double value, std::size_t count, double share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, share);
  Values values(count);
  for (double& one : values) one = value * std::exp(normal(random));
  return values;
}

/// Seeds whose scores are all worse by a factor, to a hundredth of that.
Values worse(const Values& scores, double factor, std::uint64_t seed) {
  Values values = noisy(factor, scores.size(), 0.01 * (factor - 1.0), seed);
  for (std::size_t i = 0; i < scores.size(); ++i) values[i] *= scores[i];
  return values;
}

const GateEntry& entry_of(const GateReport& report, const std::string& method) {
  const auto found = std::ranges::find_if(
      report.entries, [&](const GateEntry& entry) { return entry.change.method == method; });
  EXPECT_NE(found, report.entries.end());
  return *found;
}

TEST(Gates, CatchASlowdownAndALossOfQualityAndNothingElse) {
  ClaimRun before;
  ClaimRun after;
  const Values scores = noisy(0.1, 6, 0.05, 1);
  before.times({"slow"}, noisy(1.0, 7, 0.01, 2)).times({"calm"}, noisy(1.0, 7, 0.01, 3));
  after.times({"slow"}, noisy(1.1, 7, 0.01, 4)).times({"calm"}, noisy(1.0, 7, 0.01, 5));
  before.scores({"bad"}, "flip", scores).scores({"good"}, "flip", scores);
  after.scores({"bad"}, "flip", worse(scores, 1.2, 6)).scores({"good"}, "flip", scores);
  const GateReport report = checked(
      "[{stage: total, slower_by: 5%, methods: [slow, calm]},"
      " {metric: flip, worse_by: 5%, methods: [bad, good]}]",
      before, after);
  ASSERT_EQ(report.entries.size(), 4U);
  EXPECT_EQ(outcome_of(entry_of(report, "slow").change), Outcome::failed);
  EXPECT_EQ(outcome_of(entry_of(report, "calm").change), Outcome::passed);
  EXPECT_EQ(outcome_of(entry_of(report, "bad").change), Outcome::failed);
  EXPECT_EQ(outcome_of(entry_of(report, "good").change), Outcome::passed);
  EXPECT_EQ(report.overall(), Outcome::failed);
  EXPECT_EQ(report.count(Outcome::failed), 2U);
  const results::Table table = gate_table(report, false);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0].text, "total slower by 5%");
  EXPECT_EQ(table.notes.front(), "gates: 2 failed, 2 passed");
  // The other way round both are improvements, and improvements pass.
  EXPECT_EQ(checked("[{stage: total, slower_by: 5%, methods: [slow]},"
                    " {metric: flip, worse_by: 5%, methods: [bad]}]",
                    after, before)
                .overall(),
            Outcome::passed);
}

/// A gate below the noise cannot be re-run until it is green: it says that it does not know.
TEST(Gates, AreInconclusiveWithinTheNoise) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, noisy(1.0, 8, 0.2, 1));
  after.times({"pt"}, noisy(1.05, 8, 0.2, 2));
  EXPECT_EQ(checked("[{stage: total, slower_by: 2%}]", before, after).overall(),
            Outcome::inconclusive);
}

/// Repetitions of "val" with stages by name, and their sum as the time.
void add_stages(ClaimRun& run, const std::vector<std::pair<std::string, Values>>& stages) {
  for (std::size_t i = 0; i < stages.front().second.size(); ++i) {
    double total_s = 0.0;
    for (const auto& [path, wall_s] : stages) total_s += wall_s[i];
    run.times({"val"}, {total_s}).change([&](CellRecord& record) {
      record.repetition = static_cast<int>(i);
      record.render.stages.resize(stages.size());
      for (std::size_t k = 0; k < stages.size(); ++k) {
        record.render.stages[k].path = stages[k].first;
        record.render.stages[k].wall_s = stages[k].second[i];
      }
    });
  }
}

TEST(Gates, TellStagesApart) {
  ClaimRun before;
  ClaimRun after;
  add_stages(before, {{"gather", noisy(1.0, 8, 0.005, 1)}, {"shadow", noisy(0.2, 8, 0.005, 2)}});
  add_stages(after, {{"gather", noisy(1.0, 8, 0.005, 3)}, {"shadow", noisy(0.22, 8, 0.005, 4)}});
  // A tenth of a small stage is lost in the total.
  EXPECT_EQ(checked("[{stage: total, slower_by: 5%}]", before, after).overall(), Outcome::passed);
  EXPECT_EQ(checked("[{stage: shadow, slower_by: 5%}]", before, after).overall(), Outcome::failed);
  EXPECT_EQ(checked("[{stage: gather, slower_by: 5%}]", before, after).overall(), Outcome::passed);
}

/// What a stage is called need not be known beforehand; small ones are left alone.
TEST(Gates, OfEachStageNameTheOneThatIsSlower) {
  ClaimRun before;
  ClaimRun after;
  add_stages(before, {{"gather", noisy(1.0, 8, 0.005, 1)},
                      {"shadow", noisy(0.2, 8, 0.005, 2)},
                      {"blur", noisy(0.02, 8, 0.005, 3)},
                      {"gather/rays", noisy(0.5, 8, 0.005, 4)}});
  add_stages(after, {{"gather", noisy(1.0, 8, 0.005, 5)},
                     {"shadow", noisy(0.22, 8, 0.005, 6)},
                     {"blur", noisy(0.03, 8, 0.005, 7)},
                     {"gather/rays", noisy(0.5, 8, 0.005, 8)}});
  const GateReport report = checked("[{stage: each, slower_by: 5%}]", before, after);
  ASSERT_EQ(report.entries.size(), 2U);
  EXPECT_EQ(report.entries[0].change.quantity, "gather");
  EXPECT_EQ(outcome_of(report.entries[0].change), Outcome::passed);
  EXPECT_EQ(report.entries[1].change.quantity, "shadow");
  EXPECT_EQ(outcome_of(report.entries[1].change), Outcome::failed);
  EXPECT_NE(junit_xml(RunValues(after.run()), report)
                .find(": each stage slower by 5%: shadow\">\n      <failure"),
            std::string::npos)
      << junit_xml(RunValues(after.run()), report);
  EXPECT_EQ(checked("[{stage: each, slower_by: 5%, share: 1%}]", before, after).entries.size(), 3U);
  EXPECT_EQ(to_json(gates_of("[{stage: each, slower_by: 5%, share: 1%}]"))[0]["share"], "1%");
}

/// One that was small, or not there at all, counts by what it takes now.
TEST(Gates, OfEachStageSeeAStageThatIsNew) {
  ClaimRun before;
  ClaimRun after;
  add_stages(before, {{"gather", noisy(1.0, 8, 0.005, 1)}, {"blur", noisy(0.02, 8, 0.005, 2)}});
  add_stages(after, {{"gather", noisy(1.0, 8, 0.005, 3)},
                     {"blur", noisy(0.3, 8, 0.005, 4)},
                     {"copy", noisy(0.3, 8, 0.005, 5)}});
  const GateReport report = checked("[{stage: each, slower_by: 5%}]", before, after);
  ASSERT_EQ(report.entries.size(), 3U);
  EXPECT_EQ(outcome_of(report.entries[1].change), Outcome::failed);
  EXPECT_EQ(outcome_of(report.entries[2].change), Outcome::not_measured);
  EXPECT_EQ(report.entries[2].change.reason, "no copy in one of the runs");
}

TEST(Gates, OfEachStageTakeNoLimit) {
  for (const char* gate : {"{stage: each, at_most: 2s}", "{stage: each}",
                           "{stage: each, slower_by: 5%, at_most: 2s}"}) {
    try {
      gates_of(fmt::format("[{}]", gate));
      ADD_FAILURE() << gate;
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find("stage: each needs slower_by and takes no at_most"),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(gates_of("[{stage: each, slower_by: 5%, share: 0%}]"), base::InputError);
  EXPECT_THROW(gates_of("[{stage: total, slower_by: 5%, share: 5%}]"), base::InputError);
}

TEST(Gates, LimitsNeedNoBaseline) {
  ClaimRun run;
  run.scores({"a"}, "flip", {0.10, 0.11, 0.12}).scores({"b"}, "flip", {0.30, 0.31, 0.32});
  run.scores({"c"}, "flip", {0.18, 0.20, 0.22});
  const RunValues values(run.run());
  const GateReport report =
      check_gates(gates_of("[{metric: flip, at_most: 0.2}]"), nullptr, values, "no baseline");
  EXPECT_EQ(outcome_of(entry_of(report, "a").change), Outcome::passed);
  EXPECT_EQ(outcome_of(entry_of(report, "b").change), Outcome::failed);
  EXPECT_EQ(outcome_of(entry_of(report, "c").change), Outcome::inconclusive);
  const GateReport least =
      check_gates(gates_of("[{metric: flip, at_least: 0.25}]"), nullptr, values, "");
  EXPECT_EQ(outcome_of(entry_of(least, "a").change), Outcome::failed);
  EXPECT_EQ(outcome_of(entry_of(least, "b").change), Outcome::passed);
}

/// Nothing measured is no success.
TEST(Gates, WithoutABaselineNothingPasses) {
  ClaimRun run;
  run.times({"pt"}, {1.0, 1.0});
  const GateReport report = check_gates(gates_of("[{stage: total, slower_by: 5%}]"), nullptr,
                                        RunValues(run.run()), "there is no baseline");
  EXPECT_EQ(report.overall(), Outcome::not_measured);
  ASSERT_EQ(report.entries.size(), 1U);
  EXPECT_EQ(report.entries[0].change.reason, "no baseline");
  const results::Table table = gate_table(report, false);
  EXPECT_TRUE(table.rows.empty());
  EXPECT_EQ(table.notes,
            (std::vector<std::string>{"gates: 1 not measured", "there is no baseline"}));
  const GateReport unknown =
      check_gates(gates_of("[{metric: ssim, at_least: 0.5}]"), nullptr, RunValues(run.run()), "");
  EXPECT_EQ(unknown.overall(), Outcome::not_measured);
  ASSERT_EQ(unknown.notes.size(), 1U);
}

/// One good row hides no row that could not be judged.
TEST(Gates, ARowThatIsNotMeasuredKeepsAGateOpen) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, noisy(1.0, 7, 0.01, 1));
  after.times({"pt"}, noisy(1.0, 7, 0.01, 2)).times({"new"}, {1.0, 1.0});
  const GateReport report = checked("[{stage: total, slower_by: 5%}]", before, after);
  EXPECT_EQ(report.count(Outcome::passed), 1U);
  EXPECT_EQ(report.overall(), Outcome::not_measured);
}

TEST(Gates, ANewFailureFails) {
  ClaimRun before;
  ClaimRun after;
  before.times({"pt"}, {1.0, 1.0});
  after.times({"pt"}, {1.0}).change([](CellRecord& record) {
    record.render.status = results::Status::crash;
  });
  EXPECT_EQ(checked("[{stage: total, slower_by: 5%}]", before, after).overall(), Outcome::failed);
}

/// The rate of false alarms of a night with 60 gated rows in which nothing changed.
TEST(Gates, RaiseFewFalseAlarms) {
  int alarmed_nights = 0;
  std::uint64_t seed = 1;
  constexpr int kNights = 20;
  for (int night = 0; night < kNights; ++night) {
    ClaimRun before;
    ClaimRun after;
    for (int row = 0; row < 20; ++row) {
      const ClaimRun::Method method{"m", "row", row};
      before.times(method, noisy(1.0, 6, 0.05, seed++));
      after.times(method, noisy(1.0, 6, 0.05, seed++));
    }
    const GateReport report = checked("[{stage: total, slower_by: 5%}]", before, after);
    if (report.count(Outcome::failed) > 0) ++alarmed_nights;
  }
  EXPECT_LE(alarmed_nights, 1);
}

class Baselines : public testing::Test {
 protected:
  Baselines()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("discern-baselines-") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
  }
  ~Baselines() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_;
};

TEST_F(Baselines, KeepRecordsWithReasonAndAuthor) {
  ClaimRun first;
  first.times({"pt"}, {1.0, 1.1}).scores({"val"}, "flip", {0.1, 0.2});
  const AcceptOutcome accepted = accept(folder_, first.run(), {"Ada", "first light", {}});
  ASSERT_EQ(accepted.rows.size(), 2U);
  EXPECT_EQ(accepted.rows[0].old_hash, "");
  const std::optional<results::Run> baseline = load_baseline(accepted.file);
  ASSERT_TRUE(baseline);
  EXPECT_EQ(baseline->cells.size(), first.run().cells.size());
  EXPECT_EQ(baseline->metrics.size(), 2U);
  EXPECT_EQ(checked("[{metric: flip, worse_by: 5%, methods: [val]}]", first, first).overall(),
            Outcome::passed);

  // A later night moves one row; the other one stays what it was.
  ClaimRun second;
  second.times({"pt"}, {2.0, 2.1}).scores({"val"}, "flip", {0.3, 0.4});
  const AcceptOutcome moved = accept(
      folder_, second.run(),
      {"Bob", "slower but right", [](const CellRecord& record) { return record.method == "pt"; }});
  ASSERT_EQ(moved.rows.size(), 1U);
  EXPECT_EQ(moved.rows[0].method, "pt");
  EXPECT_NE(moved.rows[0].old_hash, "");
  const results::Run now = *load_baseline(accepted.file);
  const RunValues values(now);
  for (std::size_t i = 0; i < values.summary().rows.size(); ++i) {
    const results::SummaryRow& row = values.summary().rows[i];
    if (row.method == "pt") {
      EXPECT_DOUBLE_EQ(row.total_s->value, 2.05);
    } else {
      EXPECT_DOUBLE_EQ(row.find_score("flip", "own")->score->value, 0.15);
    }
  }
  std::ifstream file(accepted.file);
  const auto json = nlohmann::json::parse(file);
  ASSERT_EQ(json.at("accepted").size(), 2U);
  EXPECT_EQ(json.at("accepted")[1].at("author"), "Bob");
  EXPECT_EQ(json.at("accepted")[1].at("reason"), "slower but right");
}

TEST_F(Baselines, TakeNoRowWithoutAResult) {
  ClaimRun run;
  run.times({"pt"}, {1.0}).change([](CellRecord& record) {
    record.render.status = results::Status::timeout;
  });
  EXPECT_THROW(accept(folder_, run.run(), {"Ada", "why not", {}}), base::InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_));
  run.times({"val"}, {1.0});
  const AcceptOutcome outcome = accept(folder_, run.run(), {"Ada", "the rest", {}});
  EXPECT_EQ(outcome.rows.size(), 1U);
  ASSERT_EQ(outcome.left_out.size(), 1U);
  EXPECT_NE(outcome.left_out[0].find("timeout"), std::string::npos);
}

TEST_F(Baselines, AFileThatIsNoneIsRefused) {
  std::filesystem::create_directories(folder_);
  const auto file = folder_ / "x.json";
  std::ofstream(file) << "{\"schema\": 1}";
  EXPECT_THROW(load_baseline(file), base::InputError);
  EXPECT_FALSE(load_baseline(folder_ / "y.json"));
}

TEST(Junit, HasACasePerRowAndGate) {
  ClaimRun before;
  ClaimRun after;
  before.times({"a<b&\"c\""}, noisy(1.0, 7, 0.01, 1));
  after.times({"a<b&\"c\""}, noisy(1.5, 7, 0.01, 2));
  before.times({"gone"}, {1.0});
  after.times({"gone"}, {1.0}).change([](CellRecord& record) {
    record.render.status = results::Status::crash;
    record.render.reason = "signal 11\x01";
  });
  after.scores({"val"}, "flip", {0.25});
  const GateReport report =
      checked("[{stage: total, slower_by: 5%, methods: ['a<b&\"c\"']}]", before, after);
  const std::string xml = junit_xml(RunValues(after.run()), report);
  EXPECT_EQ(xml.find("a<b"), std::string::npos);
  EXPECT_NE(xml.find("a&lt;b&amp;&quot;c&quot;"), std::string::npos);
  EXPECT_NE(xml.find("<error message=\"crash: signal 11\xEF\xBF\xBD\"/>"), std::string::npos)
      << xml;
  EXPECT_NE(xml.find("errors=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("failures=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("<failure message=\"total_s "), std::string::npos);
  EXPECT_NE(xml.find("<property name=\"flip@own\" value=\"0.25\"/>"), std::string::npos);
}

}  // namespace
}  // namespace test_results
