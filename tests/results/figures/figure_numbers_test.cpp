// The tables of figures against closed forms.
#include <gtest/gtest.h>

#include "results/csv_table.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/figures.h"
#include "results/figures/step_differences.h"
#include "tests/expect_input_error.h"
#include "tests/results/figures/synthetic_suite.h"

namespace {

using results::CsvTable;
using results::RunValues;
using results::figures::figure_script;
using results::figures::FigureDrawing;
using test_figures::figures_of;
using test_figures::SyntheticSuite;
using tests::input_error_of;

/// val at 2 and 8 VALs with seeds 1 and 2, hard with seed 1; relmse = (seed + 1) / vals.
SyntheticSuite small_suite() {
  SyntheticSuite suite;
  suite.add_scene("horse");
  suite.set_metrics({"relmse"});
  for (const auto& [method, vals] :
       {std::pair{"val[vals=2]", 2.0}, std::pair{"val[vals=8]", 8.0}}) {
    suite.add_method(method);
    for (const std::uint64_t seed : {1U, 2U}) {
      SyntheticSuite::Cell cell{"horse", method, "fixed", seed};
      cell.total_s = vals;
      cell.scores = {{"relmse", (static_cast<double>(seed) + 1.0) / vals}};
      cell.noise_floor = 0.125;
      suite.add(cell);
    }
  }
  suite.add_method("hard");
  SyntheticSuite::Cell hard{"horse", "hard"};
  hard.scores = {{"relmse", 2.0}};
  suite.add(hard);
  return suite;
}

std::string csv_of(const FigureDrawing& drawing) { return to_csv(drawing.table); }

TEST(FigureNumbers, ErrorOverAParameter) {
  SyntheticSuite suite = small_suite();
  const RunValues run(suite.run());
  const auto figure =
      figures_of("- {id: a, kind: error-vs-parameter, x: vals, y: relmse, methods: [val]}");
  const FigureDrawing drawing = results::figures::parameter_figure(figure[0], run);
  // Two seeds a and b: mean (a + b) / 2, half width of the interval 12.7062 |a - b| / 2.
  ASSERT_EQ(drawing.table.rows.size(), 2U);
  const auto number = [&](std::size_t row, const std::string& column) {
    for (std::size_t i = 0; i < drawing.table.columns.size(); ++i) {
      if (drawing.table.columns[i] == column) return std::get<double>(drawing.table.rows[row][i]);
    }
    return -1.0;
  };
  EXPECT_EQ(number(0, "vals"), 2.0);
  EXPECT_EQ(number(0, "value"), 1.25);
  EXPECT_NEAR(number(0, "high"), 1.25 + 12.7062 * 0.25, 1e-4);
  EXPECT_EQ(number(1, "value"), 0.3125);
  EXPECT_EQ(number(1, "samples"), 2.0);
  // One line: its two points stand in one block, and the floor in another.
  EXPECT_NE(drawing.data.find("$line1 << end\n2 1.25 2 2"), std::string::npos) << drawing.data;
  EXPECT_NE(drawing.data.find("$line2 << end"), std::string::npos);
  EXPECT_EQ(drawing.data.find("$line3 << end"), std::string::npos);
}

TEST(FigureNumbers, ErrorsAreLogarithmicUnlessOneIsZero) {
  SyntheticSuite suite = small_suite();
  const auto figure =
      figures_of("- {id: a, kind: error-vs-parameter, x: vals, y: relmse, methods: [val]}");
  EXPECT_NE(results::figures::parameter_figure(figure[0], RunValues(suite.run()))
                .commands.find("\nset logscale y\n"),
            std::string::npos);
  SyntheticSuite::Cell perfect{"horse", "val[vals=2]", "fixed", 3};
  perfect.scores = {{"relmse", -2.5}};
  suite.add(perfect);
  EXPECT_NE(results::figures::parameter_figure(figure[0], RunValues(suite.run()))
                .commands.find("\nunset logscale y\n"),
            std::string::npos);
  const auto asked = figures_of(
      "- {id: a, kind: error-vs-parameter, x: vals, y: relmse, methods: [val], log: [y]}");
  const FigureDrawing drawing =
      results::figures::parameter_figure(asked[0], RunValues(suite.run()));
  ASSERT_EQ(drawing.page.notes.size(), 1U);
  EXPECT_EQ(drawing.page.notes[0],
            "1 value of relmse at or below 0 has no place on a logarithmic axis.");
}

TEST(FigureNumbers, AChainHasTheChangeOfEachStepOverEqualSeeds) {
  SyntheticSuite suite = small_suite();
  const RunValues run(suite.run());
  const auto figure = figures_of(
      "- {id: a, kind: error-chain, y: relmse, methods: [\"val[vals=8]\", \"val[vals=2]\", hard]}");
  const FigureDrawing drawing = results::figures::chain_figure(figure[0], run);
  ASSERT_EQ(drawing.table.rows.size(), 3U);
  const auto difference = [&](std::size_t row, std::size_t side) {
    return std::get<std::optional<double>>(drawing.table.rows[row].at(9 + side));
  };
  EXPECT_FALSE(difference(0, 0).has_value());
  // Seed 1: 1 - 0.25, seed 2: 1.5 - 0.375; their mean, not the difference of means' intervals.
  EXPECT_EQ(difference(1, 0), 0.9375);
  EXPECT_NEAR(*difference(1, 2), 0.9375 + 12.7062 * 0.1875, 1e-4);
  // One seed in common: the difference of the rows' values, and no interval.
  EXPECT_EQ(difference(2, 0), 0.75);
  EXPECT_FALSE(difference(2, 1).has_value());
}

TEST(FigureNumbers, AStepOfAChainIsOneRow) {
  SyntheticSuite suite = small_suite();
  const RunValues run(suite.run());
  const auto figure = figures_of("- {id: a, kind: error-chain, y: relmse, methods: [val, hard]}");
  EXPECT_EQ(input_error_of([&] { results::figures::chain_figure(figure[0], run); }),
            "suite.yaml:1:51: figure a: a step is one row per scene; \"val\" matches 2 in horse: "
            "val[vals=2], fixed | val[vals=8], fixed");
}

TEST(FigureNumbers, CheckpointsAreACurvePerSeed) {
  SyntheticSuite suite = small_suite();
  results::Run& stored = suite.run();
  for (int checkpoint = 0; checkpoint < 3; ++checkpoint) {
    results::CheckpointScore point;
    point.checkpoint = checkpoint;
    point.elapsed_s = 0.25 * (checkpoint + 1);
    point.score = stored.metrics.back();  // of seed 1 of hard, against full
    point.score.against = "own";
    point.score.value = 8.0 / (checkpoint + 1);
    stored.checkpoint_scores.push_back(point);
  }
  const RunValues run(stored);
  const auto figure = figures_of("- {id: a, kind: error-vs-time, y: relmse, methods: [hard]}");
  const FigureDrawing drawing = results::figures::time_figure(figure[0], run);
  // The row itself, then three checkpoints and the image that they lead to.
  ASSERT_EQ(drawing.table.rows.size(), 5U);
  EXPECT_EQ(std::get<std::string>(drawing.table.rows[1][4]), "hard, checkpoints of seed 1");
  EXPECT_EQ(std::get<double>(drawing.table.rows[1][5]), 0.25);
  EXPECT_EQ(std::get<double>(drawing.table.rows[3][8]), 8.0 / 3.0);
  EXPECT_EQ(std::get<double>(drawing.table.rows[4][8]), 2.0);
}

TEST(FigureNumbers, StagesAddUpToTheTotal) {
  SyntheticSuite suite = small_suite();
  const RunValues run(suite.run());
  const auto figure = figures_of("- {id: a, kind: stage-stack, methods: [hard]}");
  const FigureDrawing drawing = results::figures::stage_figure(figure[0], run);
  EXPECT_EQ(csv_of(drawing),
            "scene,method,budget,phase,stage,wall_s,total_s\n"
            "horse,hard,fixed,prepare,build,0.125,1\n"
            "horse,hard,fixed,prepare,lights,0.0625,1\n"
            "horse,hard,fixed,render,visibility,0.25,1\n"
            "horse,hard,fixed,render,gather,0.5,1\n"
            "horse,hard,fixed,,unattributed,0.0625,1\n");
}

TEST(FigureNumbers, ElementsOfACounterAreASeries) {
  SyntheticSuite suite;
  suite.add_scene("horse");
  suite.add_method("radiosity");
  for (int repetition = 0; repetition < 3; ++repetition) {
    SyntheticSuite::Cell cell{"horse", "radiosity", "fixed", 1, repetition};
    const double r = repetition;
    cell.counters = {{"unshot", {8.0 + r, 4.0 + r, 2.0 + r}}};
    suite.add(cell);
  }
  const RunValues run(suite.run());
  const auto figure = figures_of("- {id: a, kind: series, y: unshot}");
  EXPECT_EQ(csv_of(results::figures::series_figure(figure[0], run)),
            "quantity,scene,method,budget,element,value,low,high,samples\n"
            "unshot,horse,radiosity,fixed,0,9,8,10,3\n"
            "unshot,horse,radiosity,fixed,1,5,4,6,3\n"
            "unshot,horse,radiosity,fixed,2,3,2,4,3\n");
}

TEST(FigureNumbers, AFigureWithoutDataSaysWhatThereIs) {
  SyntheticSuite suite = small_suite();
  suite.set_metrics({"relmse", "flip"});
  const RunValues run(suite.run());
  const auto figures = figures_of(
      "- {id: a, kind: pareto, y: flip, methods: [hard]}\n"
      "- {id: b, kind: pareto, y: relmse, methods: [\"val[vals=99]\"]}\n");
  EXPECT_EQ(
      input_error_of([&] { results::figures::pareto_figure(figures[0], run); }),
      "suite.yaml:1:3: figure a: no row has flip and total_s; it looks at 1 row: hard; scores "
      "of this run: relmse, flip");
  EXPECT_EQ(input_error_of([&] { results::figures::pareto_figure(figures[1], run); }),
            "suite.yaml:2:3: figure b: no row matches its methods, scenes and budgets; methods: "
            "val[vals=2], val[vals=8], hard");
}

TEST(FigureNumbers, AFigureThatIsTooLowSaysHowHighItHasToBe) {
  SyntheticSuite suite = small_suite();
  const RunValues run(suite.run());
  const auto figure = figures_of(
      "- {id: a, kind: error-chain, y: relmse, methods: [\"val[vals=8]\", hard], size_cm: [16, "
      "4]}");
  EXPECT_EQ(input_error_of([&] { results::figures::chain_figure(figure[0], run); }),
            "size_cm: a height of 4 cm leaves no room beside title, legend and notes; accepted "
            "here: at least 4.2");
}

TEST(CsvTableText, QuotesWhatNeedsItAndKeepsEveryDigit) {
  CsvTable table{{"a,b", "c"}, {}};
  table.rows = {{std::string("say \"x\""), 0.1}, {std::string("plain"), std::optional<double>()}};
  EXPECT_EQ(to_csv(table), "\"a,b\",c\n\"say \"\"x\"\"\",0.1\nplain,\n");
}

}  // namespace
