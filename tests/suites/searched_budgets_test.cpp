#include <gtest/gtest.h>

#include "results/convergence.h"
#include "tests/suites/runs_fixture.h"

namespace tests {
namespace {

using results::CellRecord;
using results::SearchRecord;
using results::Status;

/// Suites whose budgets have to be searched.
class SearchedBudgets : public Runs {
 protected:
  results::Run run_of(const std::string& rest) { return results::load_run(run(rest).run_folder); }
};

TEST_F(SearchedBudgets, AnErrorIsMetByTheSamplesThatTheCellsThenHave) {
  const results::Run run = run_of(
      "methods: [{id: pt, renderer: path}]\n"
      "budgets: [{error: {metric: smape, at: 0.1}}]\n"
      "measure: {seeds: 2}\nmetrics: [smape]\n");
  ASSERT_EQ(run.searches.size(), 1U);
  const SearchRecord& search = run.searches.front();
  EXPECT_EQ(search.setting, "samples");
  EXPECT_EQ(search.quantity, "smape");
  EXPECT_EQ(search.budget, "smape=0.1");
  EXPECT_EQ(search.target, 0.1);
  EXPECT_LE(search.probes.size(), 8U);
  ASSERT_TRUE(search.value.has_value()) << search.reason;
  EXPECT_NEAR(search.achieved.value_or(0.0), 0.1, 0.03);
  ASSERT_EQ(run.cells.size(), 2U);
  for (const CellRecord& cell : run.cells) {
    EXPECT_EQ(cell.budget, "smape=0.1");
    EXPECT_EQ(cell.render.samples, static_cast<std::int64_t>(*search.value));
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(run.folder)) {
    EXPECT_EQ(entry.path().filename().string().find("probe"), std::string::npos) << entry.path();
  }
  // The first seed's image is the one that was probed.
  for (const results::MetricRecord& score : run.metrics) {
    if (score.cell != run.cells.front().cell || score.against != "own") continue;
    EXPECT_DOUBLE_EQ(score.value.value_or(0.0), search.achieved.value_or(1.0));
  }
}

TEST_F(SearchedBudgets, ATargetBelowTheNoiseOfTheReferenceIsSaidAndNotChased) {
  const results::Run run = run_of(
      "methods: [{id: pt, renderer: path, budgets: [{error: {metric: relmse, at: 1e-9}}]}]\n"
      "metrics: [relmse]\n");
  ASSERT_EQ(run.searches.size(), 1U);
  EXPECT_EQ(run.searches.front().outcome, "below_noise_floor");
  EXPECT_TRUE(run.searches.front().probes.empty());
  ASSERT_EQ(run.cells.size(), 1U);
  EXPECT_EQ(run.cells.front().render.status, Status::skipped);
  const std::string reason = run.cells.front().render.reason.value_or("");
  EXPECT_NE(reason.find("relmse of 1e-09 asks for less than the noise of the reference"),
            std::string::npos)
      << reason;
  EXPECT_NE(reason.find("more reference samples"), std::string::npos) << reason;
}

TEST_F(SearchedBudgets, ATimeThatEvenTheLeastSettingOutrunsIsSkippedWithItsNumbers) {
  const results::Run run = run_of(
      "methods: [{id: pt, renderer: path, search: {setting: samples, from: 64, to: 4096},\n"
      "           budgets: [{time: 1us}]}]\n");
  ASSERT_EQ(run.searches.size(), 1U);
  EXPECT_EQ(run.searches.front().outcome, "below_reach");
  EXPECT_EQ(run.cells.front().render.status, Status::skipped);
  EXPECT_NE(run.cells.front().render.reason.value_or("").find("samples 64, the least"),
            std::string::npos)
      << run.cells.front().render.reason.value_or("");
}

TEST_F(SearchedBudgets, ATimeIsSearchedWhereTheMethodDeclaresIt) {
  const results::Run run =
      run_of("methods: [{id: pt, renderer: path, search: samples, budgets: [{time: 60ms}]}]\n");
  ASSERT_EQ(run.searches.size(), 1U);
  const SearchRecord& search = run.searches.front();
  EXPECT_EQ(search.quantity, "total_s");
  EXPECT_LE(search.probes.size(), 8U);
  ASSERT_TRUE(search.value.has_value()) << search.reason;
  EXPECT_EQ(run.cells.front().render.samples, static_cast<std::int64_t>(*search.value));
}

TEST_F(SearchedBudgets, ATimeIsTheRenderersOwnClockOtherwise) {
  const results::Run run = run_of("methods: [{id: pt, renderer: path, budgets: [{time: 20ms}]}]\n");
  EXPECT_TRUE(run.searches.empty());
  EXPECT_EQ(run.cells.front().render.status, Status::ok);
}

TEST_F(SearchedBudgets, EqualTimeIsTheTimeOfTheOtherMethod) {
  const results::Run run = run_of(
      "methods: [{id: slow, renderer: path, budgets: [{samples: 300}]},\n"
      "          {id: fast, renderer: path, parameters: {max_depth: 1}}]\n"
      "budgets: [{time: {of: slow}}]\n");
  ASSERT_EQ(run.searches.size(), 1U);  // not of `slow` itself
  const SearchRecord& search = run.searches.front();
  EXPECT_EQ(search.method, "fast");
  EXPECT_EQ(search.budget, "time-of-slow");
  EXPECT_GT(search.target, 0.0);
  ASSERT_TRUE(search.value.has_value()) << search.reason;
}

TEST_F(SearchedBudgets, ASettingThatChangesWhatIsClaimedIsRefused) {
  try {
    run("methods: [{id: pt, renderer: path, budgets: [{time: 60ms}],\n"
        "           search: {setting: geometry_clamp, from: 1, to: 100}}]\n");
    FAIL() << "no error";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("geometry_clamp of method \"pt\" changes what"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(SearchedBudgets, ASecondSessionKeepsWhatWasFound) {
  const std::string rest =
      "methods: [{id: pt, renderer: path, budgets: [{error: {metric: smape, at: 0.1}}]}]\n"
      "metrics: [smape]\n";
  const auto first = run(rest);
  const auto second = run(rest);
  EXPECT_EQ(second.run_folder, first.run_folder);
  EXPECT_EQ(second.new_repetitions, 0U);
  EXPECT_EQ(line_count(first.run_folder / "searches.jsonl"), 1U);
}

TEST_F(SearchedBudgets, AFailingRendererEndsTheSearchAndIsSaid) {
  const results::Run run = run_of(
      "methods: [{id: pt, renderer: path, budgets: [{time: {of: bad}}]},\n"
      "          {id: bad, renderer: blank, parameters: {behaviour: exception}, budgets: "
      "[fixed]}]\n"
      "measure: {warmup: 0}\n");
  ASSERT_EQ(run.searches.size(), 1U);
  EXPECT_EQ(run.searches.front().outcome, "failed");
  EXPECT_NE(run.searches.front().reason.find("a render of the search failed"), std::string::npos)
      << run.searches.front().reason;
}

TEST_F(SearchedBudgets, CheckpointsGiveAConvergenceCurvePerSeed) {
  const results::Run run = run_of(
      "methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 64}]\n"
      "measure: {seeds: 2, convergence: true}\nmetrics: [relmse]\n");
  ASSERT_FALSE(run.checkpoint_scores.empty());
  const results::RunValues values(run);
  const auto curves =
      results::convergence_curves(values, 0, values.find_quantity("relmse", base::Place{}));
  ASSERT_EQ(curves.size(), 2U);
  for (const results::ConvergenceCurve& curve : curves) {
    ASSERT_GE(curve.points.size(), 3U);
    EXPECT_EQ(curve.points.back().samples, 64.0);
    EXPECT_LT(curve.points.back().error, curve.points.front().error);
    EXPECT_LE(curve.points.front().time_s, curve.points.back().time_s);
  }
}

}  // namespace
}  // namespace tests
