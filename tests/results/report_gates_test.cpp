// The gates of a run in its report: outcomes, reasons, and the marks of the overview.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/html_report/html_report.h"
#include "tests/results/synthetic_run.h"
#include "tests/temporary_folder.h"

namespace {

using nlohmann::ordered_json;

bool has(const std::string& text, const std::string& wanted) {
  return text.find(wanted) != std::string::npos;
}

/// The page of a run of two methods, 1 s and 3 s, with the given gates.
std::string page_with(const ordered_json& gates, const std::string& state = "complete") {
  const tests::TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  run.append(test_results::timed_cell("box", "quick", 1, 1.0));
  run.append(test_results::timed_cell("box", "slow<b>", 1, 3.0));
  run.write_run_json({{"schema", 1}, {"suite", "s"}, {"state", state}, {"gates", gates}});
  return results::html_report::html_report(results::load_run(run.path()));
}

const ordered_json kLimit{{"stage", "total"}, {"at_most", "2s"}};

TEST(ReportGates, TellEveryRowItsOutcomeAndReason) {
  const std::string page = page_with(ordered_json::array({kLimit}));
  EXPECT_TRUE(has(page, "<a href=\"#gates\">Gates</a>"));
  EXPECT_TRUE(has(page, "<section id=\"gates\">"));
  EXPECT_TRUE(has(page, "<b class=\"verdict not-reproduced\">✗ failed 1</b>"));
  EXPECT_TRUE(has(page, "<b class=\"verdict reproduced\">✓ passed 1</b>"));
  EXPECT_TRUE(has(page, "<td>slow&lt;b&gt;</td>"));
  EXPECT_FALSE(has(page, "<td>slow<b></td>"));
  EXPECT_TRUE(has(page, "gates: 1 failed, 1 passed") || has(page, "gates: 1 passed, 1 failed"));
}

TEST(ReportGates, MarkTheCellsOfTheOverview) {
  const std::string page = page_with(ordered_json::array({kLimit}));
  EXPECT_TRUE(has(page, "<b class=\"verdict not-reproduced\">✗ 1 gate failed</b>"));
  EXPECT_TRUE(has(page, "<b class=\"verdict reproduced\">✓ 1 gate passed</b>"));
  EXPECT_TRUE(has(page, "data-state=\"failed\""));
  EXPECT_TRUE(has(page, "data-state=\"ok\""));
}

TEST(ReportGates, WithoutABaselineAreNotMeasuredAndSayHowToMakeOne) {
  const std::string page =
      page_with(ordered_json::array({{{"stage", "total"}, {"slower_by", "5%"}}}));
  EXPECT_TRUE(has(page, "– not measured 2"));
  EXPECT_TRUE(has(page, "discern accept r --reason TEXT"));
  EXPECT_TRUE(has(page, "data-state=\"open\""));
}

TEST(ReportGates, OfARunThatGoesOnAreNotJudged) {
  const std::string page = page_with(ordered_json::array({kLimit}), "running");
  EXPECT_TRUE(has(page, "the run is not complete: its gates are not judged"));
  EXPECT_FALSE(has(page, "✗"));
}

TEST(ReportGates, ARunWithoutGatesHasNoSection) {
  const std::string page = page_with(ordered_json::array());
  EXPECT_FALSE(has(page, "id=\"gates\""));
  EXPECT_FALSE(has(page, "#gates"));
}

}  // namespace
