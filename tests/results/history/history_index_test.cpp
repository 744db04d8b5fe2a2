#include "results/history/history_index.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/history/history_output.h"
#include "tests/results/claims/claim_run.h"

namespace test_results {
namespace {

namespace fs = std::filesystem;
using namespace results::history;

class History : public testing::Test {
 protected:
  History()
      : root_(fs::path(testing::TempDir()) /
              (std::string("discern-history-") +
               testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(root_);
  }
  ~History() override { fs::remove_all(root_); }

  /// A run on disk whose method took so long.
  void add_run(const std::string& name, double total_s, const std::string& machine = "desk",
               const std::string& device = "cpu", int jobs = 1) const {
    ClaimRun run;
    run.times({"pt"}, {total_s, total_s}).scores({"pt"}, "flip", {0.1 * total_s});
    run.each_record([&](results::CellRecord& record) {
      record.machine = machine;
      record.render.device = device;
      record.jobs = jobs;
    });
    const fs::path folder = root_ / "runs/night" / name;
    auto store = results::RunFolder::open_for_writing(folder);
    nlohmann::ordered_json info = *run.run().info;
    info["suite"] = "night";
    info["environment"] = {{"started_utc", name}, {"commit", "c" + name}, {"commit_dirty", false}};
    store.write_run_json(info);
    for (const auto& record : run.run().cells) store.append(record);
    for (const auto& record : run.run().metrics) store.append(record);
  }
  Query query(const std::string& quantity = "total_s", const std::string& machine = "desk") const {
    return {"night", quantity, "half", machine, 0};
  }

  const fs::path root_;
};

TEST_F(History, FollowsAQuantityOverRuns) {
  for (int i = 0; i < 4; ++i) add_run("2026112" + std::to_string(i), i < 2 ? 1.0 : 2.0);
  HistoryIndex index(root_);
  EXPECT_EQ(index.update(false).read, 4U);
  const std::vector<Series> series = index.series(query());
  ASSERT_EQ(series.size(), 1U);
  ASSERT_EQ(series[0].points.size(), 4U);
  EXPECT_EQ(series[0].method, "pt");
  EXPECT_EQ(series[0].points[0].commit, "c20261120");
  EXPECT_DOUBLE_EQ(series[0].points[3].value.value, 2.0);
  EXPECT_EQ(series[0].points[3].value.count, 2U);
  const Trend trend = trend_of(series[0], 0.05);
  ASSERT_EQ(trend.steps.size(), 1U);
  EXPECT_EQ(trend.steps[0].at, 2U);
  EXPECT_EQ(sparkline(series[0], 32), "▁▁██");
  EXPECT_EQ(sparkline(series[0], 3), "▁██");
  const results::Table table = trend_table({trend});
  EXPECT_EQ(table.rows[0].back().text, "- +100.0 % since 20261122 (c202611)");

  const std::vector<Series> scores = index.series(query("flip"));
  ASSERT_EQ(scores.size(), 1U);
  EXPECT_DOUBLE_EQ(scores[0].points[3].value.value, 0.2);
  Query newest = query();
  newest.last = 3;
  EXPECT_EQ(index.series(newest)[0].points.size(), 3U);
}

TEST_F(History, ReadsOnlyWhatIsNewAndForgetsWhatIsGone) {
  add_run("20261120", 1.0);
  add_run("20261121", 1.0);
  {
    HistoryIndex index(root_);
    EXPECT_EQ(index.update(false).read, 2U);
    EXPECT_EQ(index.update(false).read, 0U);
    EXPECT_EQ(index.update(true).read, 2U);
  }
  add_run("20261122", 1.0);
  fs::remove_all(root_ / "runs/night/20261120");
  HistoryIndex index(root_);
  const HistoryIndex::Update update = index.update(false);
  EXPECT_EQ(update.read, 1U);
  EXPECT_EQ(update.removed, 1U);
  EXPECT_EQ(index.series(query())[0].points.size(), 2U);
}

/// The index can be thrown away, and one that is none is.
TEST_F(History, IsMadeAgainFromTheRuns) {
  add_run("20261120", 1.0);
  fs::create_directories(root_);
  std::ofstream(root_ / "history.sqlite") << "this is no database, it only says so at some length";
  HistoryIndex index(root_);
  EXPECT_EQ(index.update(false).read, 1U);
  EXPECT_EQ(index.suites(), std::vector<std::string>{"night"});
}

TEST_F(History, NeverMixesMachinesAndDevices) {
  add_run("20261120", 1.0);
  add_run("20261121", 5.0, "server");
  add_run("20261122", 1.0);
  add_run("20261123", 0.1, "desk", "GPU");
  add_run("20261124", 2.0, "desk", "cpu", 2);
  HistoryIndex index(root_);
  index.update(false);
  const std::vector<Series> desk = index.series(query());
  ASSERT_EQ(desk.size(), 3U);
  EXPECT_EQ(desk[2].device, "cpu, 2 jobs");
  EXPECT_EQ(desk[0].device, "cpu");
  EXPECT_EQ(desk[0].points.size(), 2U);
  EXPECT_EQ(desk[1].device, "GPU");
  EXPECT_EQ(index.machines("night"), (std::vector<std::string>{"desk", "server"}));
  ASSERT_EQ(index.series(query("total_s", "server")).size(), 1U);
  EXPECT_EQ(index.profiles("night", "desk"), std::vector<std::string>{"half"});
}

TEST_F(History, LeavesABrokenRunOutAndSaysSo) {
  add_run("20261120", 1.0);
  const fs::path broken = root_ / "runs/night/20261121";
  fs::create_directories(broken);
  std::ofstream(broken / "run.json") << R"({"suite": "night"})";
  std::ofstream(broken / "cells.jsonl") << R"({"schema": 1})" << '\n';
  HistoryIndex index(root_);
  const HistoryIndex::Update update = index.update(false);
  EXPECT_EQ(update.read, 1U);
  ASSERT_EQ(update.unreadable.size(), 1U);
  EXPECT_NE(update.unreadable[0].find("night/20261121"), std::string::npos);
}

}  // namespace
}  // namespace test_results
