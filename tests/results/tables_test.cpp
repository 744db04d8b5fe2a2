#include "results/tables.h"

#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/run_summary.h"
#include "tests/results/synthetic_run.h"

namespace {

using results::CellRecord;
using results::Estimate;
using results::RunSummary;
using results::ScoreSummary;
using results::Status;
using results::SummaryRow;
using test_results::full_metric_record;
using test_results::timed_cell;

results::Run run_of(std::vector<CellRecord> cells) {
  results::Run run;
  run.info = std::make_shared<nlohmann::ordered_json>(nlohmann::ordered_json::object());
  run.cells = std::move(cells);
  return run;
}

results::MetricRecord score_of(const CellRecord& cell, const std::string& metric, double value) {
  results::MetricRecord score = full_metric_record();
  score.cell = cell.cell;
  score.metric = metric;
  score.value = value;
  score.noise_floor.reset();
  return score;
}

TEST(RunSummary, TimeIsTheMedianOfAllSeedsAndRepetitions) {
  CellRecord second = timed_cell("box", "a", 1, 9.0);
  second.repetition = 1;
  const RunSummary summary =
      summarize(run_of({timed_cell("box", "a", 1, 1.0), second, timed_cell("box", "a", 2, 2.0)}));
  ASSERT_EQ(summary.rows.size(), 1U);
  const SummaryRow& row = summary.rows[0];
  EXPECT_EQ(row.total_s->value, 2.0);
  EXPECT_EQ(row.total_s->count, 3U);
  EXPECT_EQ(row.repetitions, 3U);
  EXPECT_EQ(row.seeds, 2U);
  EXPECT_EQ(row.typical, 2U);
  EXPECT_EQ(row.shown, 0U);
}

TEST(RunSummary, FailedRepetitionsHaveNoTime) {
  CellRecord failed = timed_cell("box", "a", 1, 500.0);
  failed.render.status = Status::timeout;
  failed.render.image.clear();
  const RunSummary summary = summarize(run_of({failed, timed_cell("box", "a", 2, 2.0)}));
  const SummaryRow& row = summary.rows[0];
  EXPECT_EQ(row.total_s->value, 2.0);
  EXPECT_EQ(row.total_s->count, 1U);
  EXPECT_TRUE(row.has_failure());
  EXPECT_EQ(format_statuses(row), "1 ok, 1 timeout");
  EXPECT_EQ(row.shown, 1U);
  EXPECT_EQ(summary.ok_cells, 1U);
  EXPECT_EQ(summary.failed_cells, 1U);
}

TEST(RunSummary, UnsupportedIsNoFailure) {
  CellRecord cell = timed_cell("box", "a", 1, 0.0);
  cell.render.status = Status::unsupported;
  const RunSummary summary = summarize(run_of({cell}));
  EXPECT_FALSE(summary.rows[0].has_failure());
  EXPECT_EQ(summary.skipped_cells, 1U);
  EXPECT_EQ(summary.failed_cells, 0U);
  EXPECT_EQ(format_statuses(summary.rows[0]), "unsupported");
  EXPECT_FALSE(summary.rows[0].total_s.has_value());
}

TEST(RunSummary, ScoresAreMeansOverSeedsOfMediansOverFrames) {
  const CellRecord a = timed_cell("box", "a", 1, 1.0);
  const CellRecord b = timed_cell("box", "a", 2, 1.0);
  auto run = run_of({a, b});
  run.metrics = {score_of(a, "flip", 1.0), score_of(a, "flip", 9.0), score_of(a, "flip", 2.0),
                 score_of(b, "flip", 5.0)};
  const RunSummary summary = summarize(run);
  const ScoreSummary* score = summary.rows[0].find_score("flip", "full");
  ASSERT_NE(score, nullptr);
  EXPECT_EQ(score->score->value, 3.5);  // (2 + 5) / 2, not (4 + 5) / 2
  EXPECT_EQ(score->score->count, 2U);
  EXPECT_FALSE(summary.rows[0].find_score("flip", "own")->score.has_value());
}

TEST(RunSummary, ANonFiniteFrameMakesTheSeedNonFinite) {
  const CellRecord a = timed_cell("box", "a", 1, 1.0);
  const CellRecord b = timed_cell("box", "a", 2, 1.0);
  auto run = run_of({a, b});
  run.metrics = {score_of(a, "flip", 1.0), score_of(a, "flip", 3.0), score_of(b, "flip", 5.0)};
  run.metrics[1].value.reset();
  const RunSummary summary = summarize(run);
  const ScoreSummary* score = summary.rows[0].find_score("flip", "full");
  EXPECT_EQ(score->non_finite, 1U);
  EXPECT_EQ(score->score->value, 5.0);
}

/// Whether a score of a metric is marked, given its noise floor.
bool is_marked(const std::string& metric, double value, double noise_floor) {
  const CellRecord cell = timed_cell("box", "a", 1, 1.0);
  auto run = run_of({cell});
  run.metrics = {score_of(cell, metric, value)};
  run.metrics[0].noise_floor = noise_floor;
  return summarize(run).rows[0].find_score(metric, "full")->has_reference_noise;
}

TEST(RunSummary, MarksScoresWhoseErrorIsMoreThanATenthNoise) {
  // flip: 0 is best.
  EXPECT_TRUE(is_marked("flip", 0.01, 0.02));
  EXPECT_TRUE(is_marked("flip", 0.2, 0.021));
  EXPECT_FALSE(is_marked("flip", 0.2, 0.019));
  EXPECT_FALSE(is_marked("flip", 0.0, 0.0));
  // ssim: 1 is best, so the errors are 0.2 and 0.021 or 0.019.
  EXPECT_TRUE(is_marked("ssim", 0.8, 0.979));
  EXPECT_FALSE(is_marked("ssim", 0.8, 0.981));
  // psnr: no finite best; a tenth of the squared error is 10 dB.
  EXPECT_TRUE(is_marked("psnr", 50.0, 40.0));
  EXPECT_TRUE(is_marked("psnr", 50.0, 59.9));
  EXPECT_FALSE(is_marked("psnr", 50.0, 60.1));
  // Of a metric of another build no distance is known.
  EXPECT_TRUE(is_marked("of-another-build", 0.01, 0.01));
  EXPECT_FALSE(is_marked("of-another-build", 0.011, 0.01));
}

/// Three seeds with a psnr each (as far as given), and the printed score of their row.
std::string psnr_text(const std::vector<std::optional<double>>& values) {
  std::vector<CellRecord> cells;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    cells.push_back(timed_cell("box", "a", seed, 1.0));
  }
  auto run = run_of(cells);
  for (std::size_t i = 0; i < values.size(); ++i) {
    results::MetricRecord score = score_of(cells[i], "psnr", values[i].value_or(0.0));
    score.is_infinite = values[i] && std::isinf(*values[i]);
    if (!values[i] || score.is_infinite) score.value.reset();
    run.metrics.push_back(score);
  }
  const RunSummary summary = summarize(run);
  const SummaryRow& row = summary.rows[0];
  return format_score(row, *row.find_score("psnr", "full"));
}

TEST(RunSummary, SeedsThatAreLeftOutAreSaid) {
  constexpr double kPerfect = std::numeric_limits<double>::infinity();
  EXPECT_EQ(psnr_text({28.0, 30.0, 32.0}), "30.0 ±5.0");
  EXPECT_EQ(psnr_text({30.0, std::nullopt, std::nullopt}), "30.0 (1 of 3 seeds)");
  EXPECT_EQ(psnr_text({30.0}), "30.0 (1 of 3 seeds)");  // the others have no score
  EXPECT_EQ(psnr_text({kPerfect, kPerfect, kPerfect}), "∞");
  EXPECT_EQ(psnr_text({kPerfect, 30.0, kPerfect}), "30.0 (1 of 3 seeds)");
  EXPECT_EQ(psnr_text({kPerfect, kPerfect, std::nullopt}), "∞ (2 of 3 seeds)");
  EXPECT_EQ(psnr_text({std::nullopt, std::nullopt, std::nullopt}), "n/a");
}

TEST(RunSummary, ASeedIsPerfectOnlyIfEveryFrameIs) {
  const CellRecord cell = timed_cell("box", "a", 1, 1.0);
  auto run = run_of({cell});
  run.metrics = {score_of(cell, "psnr", 30.0), score_of(cell, "psnr", 0.0)};
  run.metrics[1].value.reset();
  run.metrics[1].is_infinite = true;
  RunSummary summary = summarize(run);
  EXPECT_EQ(summary.rows[0].find_score("psnr", "full")->perfect, 0U);
  EXPECT_EQ(summary.rows[0].find_score("psnr", "full")->non_finite, 1U);
  run.metrics[0] = run.metrics[1];
  summary = summarize(run);
  EXPECT_EQ(summary.rows[0].find_score("psnr", "full")->perfect, 1U);
  EXPECT_TRUE(std::isinf(*summary_table(summary).rows[0][6].sort_value));
}

TEST(RunSummary, OrderIsTheSuitesAndPlannedCellsAreNotYet) {
  auto run = run_of({timed_cell("box", "b", 1, 1.0), timed_cell("box", "a", 1, 1.0)});
  nlohmann::ordered_json info;
  info["methods"] = {{{"id", "a"}}, {{"id", "b"}}};
  info["metrics"] = {"psnr", "flip"};
  info["planned_cells"] = {
      {{"cell", run.cells[0].cell}, {"scene", "box"}, {"method", "b"}, {"budget", "64spp"}},
      {{"cell", "x"}, {"scene", "attic"}, {"method", "a"}, {"budget", "64spp"}}};
  run.info = std::make_shared<nlohmann::ordered_json>(info);
  const RunSummary summary = summarize(run);
  ASSERT_EQ(summary.rows.size(), 3U);
  EXPECT_EQ(summary.rows[0].method, "a");
  EXPECT_EQ(summary.rows[1].method, "b");
  EXPECT_EQ(summary.rows[2].scene, "attic");
  EXPECT_EQ(format_statuses(summary.rows[2]), "not yet");
  EXPECT_EQ(summary.missing_cells, 1U);
  EXPECT_EQ(summary.metrics, (std::vector<std::string>{"psnr", "flip"}));
}

TEST(Formats, TimeAndScoreShowTheLargerHalfOfTheirInterval) {
  EXPECT_EQ(results::format_time({1.24, 1.24, 1.24, 1}), "1.24 s");
  EXPECT_EQ(results::format_time({2.0, 1.9, 2.04, 5}), "2.00 s ±5.0 %");
  EXPECT_EQ(results::format_time({2.0, 2.0, 2.0, 5}), "2.00 s ±<0.1 %");
  EXPECT_EQ(results::format_score({0.0123, 0.0119, 0.0126, 4}), "0.0123 ±0.00040");
  EXPECT_EQ(results::format_score({0.5, 0.5, 0.5, 1}), "0.500");
}

TEST(TextTable, ColumnsAreAlignedAndDirectionsMarked) {
  const CellRecord a = timed_cell("box", "a-long-name", 1, 1.0);
  const CellRecord b = timed_cell("box", "b", 1, 0.002);
  auto run = run_of({a, b});
  run.metrics = {score_of(a, "psnr", 30.0), score_of(b, "psnr", 5.0)};
  run.metrics[0].noise_floor = 29.0;
  const std::string text = to_text(summary_table(summarize(run)));
  EXPECT_EQ(text,
            "scene  method       budget  reps  total ↓  psnr (own) ↑  psnr (full) ↑  status\n"
            "                                   median            dB             dB\n"
            "box    a-long-name  64spp      1   1.00 s       not yet          ~30.0  ok\n"
            "box    b            64spp      1  2.00 ms       not yet           5.00  ok\n"
            "↓ lower is better, ↑ higher is better; ± is the 95 % interval\n"
            "(own) against the transport the method claims, (full) against all light\n"
            "~ more than a tenth of it is noise of the reference\n");
}

TEST(TextTable, ShortSeriesAreSaidToHaveARange) {
  const auto note_for = [](int repetitions) {
    std::vector<CellRecord> cells;
    for (int i = 0; i < repetitions; ++i) cells.push_back(timed_cell("box", "a", 1, 1.0 + 0.1 * i));
    return results::interval_note(summarize(run_of(cells)));
  };
  EXPECT_EQ(note_for(1), "± is the 95 % interval");
  EXPECT_EQ(note_for(5),
            "± is the 95 % interval; for times of fewer than 6 repetitions it is their range");
  EXPECT_EQ(note_for(6), "± is the 95 % interval");
}

TEST(TextTable, SortValuesAreTheNumbersShown) {
  const CellRecord a = timed_cell("box", "a", 1, 1.5);
  const results::Table table = summary_table(summarize(run_of({a})));
  ASSERT_EQ(table.rows.size(), 1U);
  ASSERT_EQ(table.rows[0].size(), table.columns.size());
  EXPECT_EQ(table.rows[0][4].sort_value, 1.5);
}

}  // namespace
