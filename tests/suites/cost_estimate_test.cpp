#include "suites/cost_estimate.h"

#include <limits>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "suites/cost_records.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using results::RenderRecord;
using suites::CostEstimate;

/// Plans of 16x16 pixels and costs that were never measured.
class CostEstimates : public tests::Runs {
 protected:
  CostEstimate estimate(const std::string& rest, const std::string& head = tests::kSuiteHead,
                        const std::vector<std::int64_t>& stored = {}) {
    suite_ = tests::suite_from(folder_.path(), head + rest);
    scenes_ = suites::load_scenes(suite_);
    plan_ = suites::make_plan(suite_, scenes_);
    std::vector<std::int64_t> samples = stored;
    samples.resize(plan_.references.size());
    return suites::estimate_cost(plan_, records_, samples);
  }
  std::string hash_of_walls() {
    const auto suite = tests::suite_from(
        folder_.path(), tests::kSuiteHead + "methods: [{id: b, renderer: blank}]\n");
    return suites::load_scenes(suite)[0].first().hash.hex();
  }
  /// 8x8 pixels with 2 samples: prepare 1 s, render 0.5 s, start 3 s.
  static RenderRecord record(const std::string& scene_hash) {
    RenderRecord made;
    made.renderer = "path";
    made.scene_hash = scene_hash;
    made.width_px = 8;
    made.height_px = 8;
    made.samples = 2;
    made.prepare_s = 1.0;
    made.render_s = 0.5;
    made.start_up_s = 3.0;
    return made;
  }

  suites::Suite suite_;
  std::vector<suites::SceneStates> scenes_;
  suites::RunPlan plan_;
  suites::CostRecords records_;
};

const std::string kPath = "methods: [{id: pt, renderer: path}]\n";

TEST_F(CostEstimates, RenderIsScaledByPixelsAndSamplesPrepareIsNot) {
  records_.repetitions = {record("elsewhere")};
  const CostEstimate made = estimate(
      kPath + "budgets: [{samples: 8}]\nmeasure: {seeds: 2, repetitions: {min: 3, max: 5}}\n");
  EXPECT_EQ(made.cells, 2U);
  EXPECT_EQ(made.least_repetitions, 6U);
  EXPECT_EQ(made.most_repetitions, 10U);
  EXPECT_EQ(made.from_same_renderer, 2U);
  // 1 s + 0.5 s x 4 (pixels) x 4 (samples) = 9 s; one worker starts once.
  EXPECT_DOUBLE_EQ(made.total.least_s, 3.0 + 6 * 9.0);
  EXPECT_DOUBLE_EQ(made.total.most_s, 3.0 + 10 * 9.0);
}

TEST_F(CostEstimates, TheSameSceneCountsMoreThanTheSameParameters) {
  RenderRecord here = record(hash_of_walls());
  here.prepare_s = 2.0;
  records_.repetitions = {record("elsewhere"), here, record("elsewhere")};
  const CostEstimate made = estimate(kPath + "budgets: [{samples: 2}]\n");
  EXPECT_EQ(made.from_same_scene, 1U);
  EXPECT_DOUBLE_EQ(made.total.least_s, 3.0 + 2.0 + 0.5 * 4);
}

TEST_F(CostEstimates, OfTheSameSceneTheSameParametersCountMost) {
  estimate(kPath);
  RenderRecord same = record(hash_of_walls());
  same.parameters = suite_.methods[0].choice.parameters.entries();
  same.prepare_s = 7.0;
  RenderRecord other = same;
  other.prepare_s = 1.0;
  for (auto& [name, value] : other.parameters) {
    if (name == "max_depth") value = std::int64_t{2};
  }
  records_.repetitions = {other, same, other};
  const CostEstimate made = estimate(kPath + "budgets: [{samples: 2}]\n");
  EXPECT_DOUBLE_EQ(made.total.least_s, 3.0 + 7.0 + 2.0);
}

TEST_F(CostEstimates, TheMedianOfEquallyNearRecordsIsTaken) {
  for (const double prepare_s : {1.0, 100.0, 2.0}) {
    records_.repetitions.push_back(record("elsewhere"));
    records_.repetitions.back().prepare_s = prepare_s;
  }
  EXPECT_DOUBLE_EQ(estimate(kPath + "budgets: [{samples: 2}]\n").total.least_s, 3.0 + 2.0 + 2.0);
}

TEST_F(CostEstimates, RecordsOfSimilarWorkCountMoreThanSmallOnes) {
  RenderRecord large = record("elsewhere");
  large.width_px = large.height_px = 16;
  large.samples = 4;
  large.render_s = 1.0;  // a quarter of what the small one comes to
  records_.repetitions = {record("elsewhere"), large, record("elsewhere")};
  EXPECT_DOUBLE_EQ(estimate(kPath + "budgets: [{samples: 8}]\n").total.least_s, 3.0 + 1.0 + 2.0);
}

TEST_F(CostEstimates, FailuresAndTimesThatAreNoNumbersAreNoMeasurements) {
  RenderRecord failed = record("elsewhere");
  failed.status = results::Status::timeout;
  RenderRecord lost = record("elsewhere");
  lost.render_s = std::numeric_limits<double>::quiet_NaN();
  RenderRecord other = record("elsewhere");
  other.renderer = "blank";
  records_.repetitions = {failed, lost, other};
  const CostEstimate made = estimate(kPath + "budgets: [{samples: 2}]\nmetrics: [mse]\n");
  EXPECT_EQ(made.unmeasured_cells, 1U);
  EXPECT_EQ(made.unmeasured_references, 1U);
  EXPECT_EQ(made.references, 1U);
  EXPECT_EQ(made.total.most_s, 0.0);
}

TEST_F(CostEstimates, TimeBudgetsCountAsThemselves) {
  const CostEstimate made = estimate(
      kPath + "budgets: [{time: 2s}]\nmeasure: {new_view: true, repetitions: {min: 2, max: 3}}\n");
  EXPECT_EQ(made.from_time_budget, 1U);
  EXPECT_EQ(made.unmeasured_cells, 0U);
  EXPECT_DOUBLE_EQ(made.total.least_s, 2 * 4.0);
  EXPECT_DOUBLE_EQ(made.total.most_s, 3 * 4.0);
}

TEST_F(CostEstimates, ASearchCostsThreeRepetitionsOfTheFirstSeed) {
  records_.repetitions = {record("elsewhere")};
  const std::string rest = "budgets: [{time: 2s}]\nmeasure: {seeds: 2}\n";
  EXPECT_DOUBLE_EQ(estimate(kPath + rest).total.least_s, 3.0 + 2 * 2.0);
  EXPECT_DOUBLE_EQ(
      estimate("methods: [{id: pt, renderer: path, search: samples}]\n" + rest).total.least_s,
      3.0 + 2 * 2.0 + 3 * 2.0);
}

TEST_F(CostEstimates, ALongPrepareIsRepeatedTheLeastNumberOfTimes) {
  records_.repetitions = {record("elsewhere")};
  records_.repetitions[0].prepare_s = 11.0;
  const CostEstimate made =
      estimate(kPath + "budgets: [{samples: 2}]\nmeasure: {repetitions: {min: 2, max: 9}}\n");
  EXPECT_EQ(made.most_repetitions, 2U);
  EXPECT_DOUBLE_EQ(made.total.most_s, 3.0 + 2 * 13.0);
}

TEST_F(CostEstimates, ASequencesFollowingFramesHaveTheirOwnCost) {
  RenderRecord next = record("elsewhere");
  next.next_frame_s = 0.75;
  next.prepare_s = std::numeric_limits<double>::quiet_NaN();
  next.update_s = 0.25;
  records_.repetitions = {record("elsewhere"), next};
  const std::string rest = kPath + "budgets: [{samples: 2}]\n";
  // 1 + 4 x 0.5, then three frames of 0.25 + 4 x 0.5.
  EXPECT_DOUBLE_EQ(estimate(rest, tests::kSequenceHead).total.least_s, 3.0 + 3.0 + 3 * 2.25);
  // Where none was measured a frame is taken to cost as much as the first.
  records_.repetitions.pop_back();
  EXPECT_DOUBLE_EQ(estimate(rest, tests::kSequenceHead).total.least_s, 3.0 + 4 * 3.0);
}

TEST_F(CostEstimates, ReferencesCostWhatTheNearestOnesDidPerPixelAndSample) {
  records_.references = {{"elsewhere", "path", "full", 4.0, 1.0},
                         {"elsewhere", "path", "direct", 4.0, 2.0},
                         {"elsewhere", "blank", "full", 4.0, 36.0}};
  const std::string rest = kPath + "budgets: [{time: 1s}]\nmetrics: [mse]\n";
  const CostEstimate made = estimate(rest);
  EXPECT_EQ(made.references, 1U);
  EXPECT_DOUBLE_EQ(made.references_s, 0.25 * 256 * 16);
  EXPECT_DOUBLE_EQ(made.total.least_s, made.references_s + 1.0);
  // Half of its samples are stored, and then all.
  EXPECT_DOUBLE_EQ(estimate(rest, tests::kSuiteHead, {8}).references_s, 0.25 * 256 * 8);
  EXPECT_EQ(estimate(rest, tests::kSuiteHead, {16}).references, 0U);
  records_.references.push_back({hash_of_walls(), "path", "direct", 8.0, 1.0});
  EXPECT_DOUBLE_EQ(estimate(rest).references_s, 0.125 * 256 * 16);
}

TEST(CostText, HasHoursMinutesAndSeconds) {
  EXPECT_EQ(suites::cost_text(0.2), "under 1 s");
  EXPECT_EQ(suites::cost_text(12.4), "12 s");
  EXPECT_EQ(suites::cost_text(59.7), "1 min 00 s");
  EXPECT_EQ(suites::cost_text(200.0), "3 min 20 s");
  EXPECT_EQ(suites::cost_text(3599.8), "1 h 00 min");
  EXPECT_EQ(suites::cost_text(36.25 * 3600), "36 h 15 min");
}

TEST_F(CostEstimates, TheNewestRunOfTheMachineIsLoaded) {
  const auto write_run = [&](const std::string& suite, const std::string& name,
                             const std::string& machine, double prepare_s) {
    results::RunFolder run =
        results::RunFolder::open_for_writing(folder_.path() / "results" / "runs" / suite / name);
    run.write_run_json({{"schema", 1}, {"identity", {{"machine", machine}}}});
    results::CellRecord cell;
    cell.cell = "a";
    cell.render = record("elsewhere");
    cell.render.prepare_s = prepare_s;
    run.append(cell);
  };
  write_run("one", "20260101T000000Z-a", "here", 1.0);
  write_run("one", "20260102T000000Z-a", "here", 2.0);
  write_run("one", "20260103T000000Z-a", "there", 3.0);
  write_run("two", "20260101T000000Z-a", "here", 4.0);
  write_run("two", "20260102T000000Z-a", "here", 5.0);
  base::write_text_file(folder_.path() / "results/runs/two/20260102T000000Z-a/cells.jsonl",
                        "{\"schema\": 1}\n");
  const auto write_reference = [&](const std::string& name, const std::string& text) {
    std::filesystem::create_directories(folder_.path() / "results/references" / name);
    base::write_text_file(folder_.path() / "results/references" / name / "reference.json", text);
  };
  const std::string reference =
      R"({"schema": 1, "scene_hash": "ab", "renderer": "path", "transport": "full",
          "size_px": [4, 8], "samples": 2, "seconds": 16.0, "machine": "here"})";
  write_reference("a", reference);
  write_reference("b", std::string(reference).replace(reference.find("here"), 4, "away"));
  write_reference("c", "{");
  const suites::StoredCosts costs = suites::load_costs(folder_.path() / "results", "here");
  EXPECT_EQ(costs.runs, 2U);
  EXPECT_EQ(costs.unreadable, 2U);
  ASSERT_EQ(costs.records.repetitions.size(), 2U);
  EXPECT_EQ(costs.records.repetitions[0].prepare_s, 2.0);
  EXPECT_EQ(costs.records.repetitions[1].prepare_s, 4.0);
  ASSERT_EQ(costs.records.references.size(), 1U);
  EXPECT_DOUBLE_EQ(costs.records.references[0].pixel_samples, 64.0);
  EXPECT_DOUBLE_EQ(costs.records.references[0].seconds, 16.0);
  EXPECT_TRUE(suites::load_costs(folder_.path() / "nothing", "here").records.repetitions.empty());
}

TEST_F(CostEstimates, ARunIsWhatTheNextEstimateIsMadeFrom) {
  const std::string rest = kPath + "budgets: [{samples: 4}]\nmetrics: [mse]\n";
  const suites::RunOutcome outcome = run(rest);
  const std::string machine =
      results::load_run(outcome.run_folder).info->at("identity").at("machine");
  records_ = suites::load_costs(folder_.path() / "results", machine).records;
  const CostEstimate made = estimate(rest);
  EXPECT_EQ(made.from_same_scene, 1U);
  EXPECT_EQ(made.unmeasured_cells + made.unmeasured_references, 0U);
  const RenderRecord render = records_of(outcome)[0].render;
  // The reference is planned anew here: its cost is what it was.
  EXPECT_NEAR(made.total.least_s,
              render.prepare_s + render.render_s + render.start_up_s + made.references_s, 1e-9);
  EXPECT_GT(made.references_s, 0.0);
}

}  // namespace
