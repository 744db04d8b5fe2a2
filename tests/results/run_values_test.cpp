// Rows by selector and quantities by name: what claims, figures and tables ask a run for.
#include "results/run_values.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/expect_input_error.h"
#include "tests/results/claims/claim_run.h"

namespace {

using results::CellRecord;
using results::Quantity;
using results::RowSelector;
using results::RunValues;
using results::Sample;
using test_results::ClaimRun;
using tests::input_error_of;

ClaimRun::Method val(int vals, const std::string& scene = "box") {
  return {"val", "vals", vals, scene};
}

/// val[vals=2|5|10] on box, val[vals=2] on room, pt on box.
ClaimRun several_rows() {
  ClaimRun run;
  run.times(val(2), {1.0, 3.0}).times(val(5), {2.0}).times(val(10), {4.0});
  run.times(val(2, "room"), {5.0}).times({"pt"}, {6.0});
  return run;
}

std::vector<std::string> selected(const ClaimRun& run, const std::string& text) {
  const RunValues values(run.run());
  std::vector<std::string> names;
  for (const std::size_t row :
       select_rows(values.rows(), results::parse_row_selector(text, {}), {})) {
    names.push_back(values.rows()[row].method + " " + values.rows()[row].scene);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(RowSelectors, TakeMethodsWithTheirSweepValuesOrAllOfThem) {
  const ClaimRun run = several_rows();
  EXPECT_EQ(selected(run, "pt"), Names{"pt box"});
  EXPECT_EQ(selected(run, "*").size(), 5U);
  EXPECT_EQ(selected(run, "val").size(), 4U);
  EXPECT_EQ(selected(run, "VAL").size(), 4U) << "names compare as everywhere";
  EXPECT_EQ(selected(run, "val[vals=5]"), Names{"val[vals=5] box"});
}

TEST(RowSelectors, TakeAlternativesRangesAndRelations) {
  const ClaimRun run = several_rows();
  EXPECT_EQ(selected(run, "val[vals=2|10, scene=box]"),
            (Names{"val[vals=2] box", "val[vals=10] box"}));
  EXPECT_EQ(selected(run, "val[vals=5..10]"), (Names{"val[vals=5] box", "val[vals=10] box"}));
  EXPECT_EQ(selected(run, "val[vals=2..4|10, scene=box]").size(), 2U);
  EXPECT_EQ(selected(run, "val[vals!=2]").size(), 2U);
  EXPECT_EQ(selected(run, "val[vals < 5]").size(), 2U);
  EXPECT_EQ(selected(run, "val[vals <= 5]").size(), 3U);
  EXPECT_EQ(selected(run, "val[vals>5]"), Names{"val[vals=10] box"});
  EXPECT_EQ(selected(run, "val[vals>=5.0]").size(), 2U) << "numbers compare as numbers";
  EXPECT_EQ(selected(run, "val[vals=7]"), Names{}) << "no error: perhaps another profile has it";
}

TEST(RowSelectors, TakeKeysOfRowsThatHaveThem) {
  const ClaimRun run = several_rows();
  EXPECT_EQ(selected(run, "*[scene=room]"), Names{"val[vals=2] room"});
  EXPECT_EQ(selected(run, "*[vals=2|5|10]").size(), 4U) << "pt has no vals";
  EXPECT_EQ(selected(run, "*[renderer=path, preset=best, budget=64spp, max_depth=8]").size(), 5U);
}

TEST(RowSelectors, RefuseWhatDoesNotExist) {
  const ClaimRun run = several_rows();
  EXPECT_EQ(input_error_of([&] { selected(run, "vla"); }),
            "unknown method \"vla\"; known: val, pt");
  EXPECT_EQ(
      input_error_of([&] { selected(run, "pt[vals=2]"); }),
      "unknown key \"vals\"; known: faces, max_depth, renderer, preset, method, scene, budget");
  const base::Place place{"s.yaml", 3, 10};
  const auto error = [&](const char* text) {
    return input_error_of([&] { results::parse_row_selector(text, place); });
  };
  EXPECT_EQ(error("val[vals]"),
            "s.yaml:3:18: \"val[vals]\": \"]\" at character 9; accepted: = != < <= > >=");
  EXPECT_EQ(error("val[vals="),
            "s.yaml:3:19: \"val[vals=\": the end at character 10; accepted: a value");
  EXPECT_EQ(error("val[vals=2"),
            "s.yaml:3:20: \"val[vals=2\": the end at character 11; accepted: , or ]");
  EXPECT_EQ(error("val[vals<2|3]").substr(0, 48),
            "s.yaml:3:20: \"val[vals<2|3]\": \"|\" at character 1");
  EXPECT_EQ(error("val pt").substr(0, 29), "s.yaml:3:13: \"val pt\": \" pt\" ");
}

std::optional<double> estimate(const ClaimRun& run, const std::string& quantity,
                               const std::string& row = "val[vals=2, scene=box]") {
  const RunValues values(run.run());
  const std::vector<std::size_t> rows =
      select_rows(values.rows(), results::parse_row_selector(row, {}), {});
  const auto found = values.estimate(rows.at(0), values.find_quantity(quantity, {}));
  return found ? std::optional(found->value) : std::nullopt;
}

TEST(Quantities, AreFoundByKind) {
  ClaimRun run = several_rows();
  run.scores({"pt"}, "relmse", {0.25});
  const RunValues values(run.run());
  const auto kind = [&](const char* text) { return values.find_quantity(text, {}).kind; };
  EXPECT_EQ(kind("total_s"), Quantity::Kind::time);
  EXPECT_EQ(kind("pixels"), Quantity::Kind::time);
  EXPECT_EQ(kind("gather"), Quantity::Kind::stage);
  EXPECT_EQ(kind("build/bvh"), Quantity::Kind::stage);
  EXPECT_EQ(kind("rays"), Quantity::Kind::counter);
  EXPECT_EQ(kind("relmse"), Quantity::Kind::score);
  EXPECT_EQ(kind("max-depth"), Quantity::Kind::parameter);
  EXPECT_EQ(kind("faces"), Quantity::Kind::parameter);
  EXPECT_EQ(values.find_quantity("total_s", {}).unit, "s");
  EXPECT_EQ(values.find_quantity("peak_memory_bytes", {}).unit, "bytes");
  EXPECT_DOUBLE_EQ(*estimate(run, "total_s"), 2.0) << "median of 1 and 3";
  EXPECT_DOUBLE_EQ(*estimate(run, "pixels"), 640.0 * 480.0);
  EXPECT_DOUBLE_EQ(*estimate(run, "gather"), 0.3);
  EXPECT_DOUBLE_EQ(*estimate(run, "rays"), 1024.0);
  EXPECT_DOUBLE_EQ(*estimate(run, "links"), 1.75) << "median of the series 1, 2.5";
  EXPECT_DOUBLE_EQ(*estimate(run, "vals"), 2.0);
  EXPECT_DOUBLE_EQ(*estimate(run, "faces"), 18.0);
  EXPECT_DOUBLE_EQ(*estimate(run, "relmse", "pt"), 0.25);
  EXPECT_DOUBLE_EQ(*estimate(run, "relmse.p95", "pt"), 0.5);
  EXPECT_EQ(estimate(run, "relmse"), std::nullopt) << "no score of this row";
  EXPECT_EQ(estimate(run, "relmse@full", "pt"), std::nullopt);
}

TEST(Quantities, OfScoresAreOwnOrFull) {
  ClaimRun run;
  run.scores({"pt"}, "relmse", {0.25});
  results::Run stored = run.run();
  stored.metrics.push_back(stored.metrics.front());
  stored.metrics.back().against = "full";
  stored.metrics.back().value = 0.75;
  stored.metrics.back().details = {{"p95", 0.9}};
  const RunValues values(stored);
  const auto value = [&](const char* text) {
    return values.estimate(0, values.find_quantity(text, {}))->value;
  };
  EXPECT_EQ(value("relmse"), 0.25);
  EXPECT_EQ(value("relmse@own"), 0.25);
  EXPECT_EQ(value("relmse@full"), 0.75);
  EXPECT_EQ(value("relmse.p95@full"), 0.9);
  EXPECT_EQ(value("score.relmse@full"), 0.75);
}

TEST(Quantities, OfSeveralKindsNeedThePrefix) {
  ClaimRun run;
  run.times({"a"}, {1.0}).change([](CellRecord& cell) {
    cell.render.counters = {{"gather", 7.0}, {"max_depth", 3.0}, {"samples", 5.0}};
  });
  EXPECT_EQ(input_error_of([&] { estimate(run, "gather", "a"); }),
            "\"gather\" is the name of several things here; write one of: stage.gather, "
            "counter.gather");
  EXPECT_DOUBLE_EQ(*estimate(run, "stage.gather", "a"), 0.15);
  EXPECT_DOUBLE_EQ(*estimate(run, "counter.gather", "a"), 7.0);
  EXPECT_DOUBLE_EQ(*estimate(run, "max_depth", "a"), 8.0) << "the parameter goes first";
  EXPECT_DOUBLE_EQ(*estimate(run, "counter.max_depth", "a"), 3.0);
  EXPECT_DOUBLE_EQ(*estimate(run, "samples", "a"), 64.0) << "the record's field";
  EXPECT_DOUBLE_EQ(*estimate(run, "counter.samples", "a"), 5.0);
}

TEST(Quantities, OfMetricsWithParametersAreNamedByTheirText) {
  ClaimRun run;
  run.scores({"a"}, "relmse,trim=0.001", {0.1});
  EXPECT_DOUBLE_EQ(*estimate(run, "relmse,trim=0.001", "a"), 0.1);
  EXPECT_DOUBLE_EQ(*estimate(run, "relmse,trim=0.001.p95", "a"), 0.2);
  run.scores({"a"}, "flip,ppd=30", {0.2});
  EXPECT_EQ(estimate(run, "flip", "a"), std::nullopt) << "the text itself goes first";
  run.scores({"b"}, "ssim,a=1", {0.3}).scores({"b"}, "ssim,a=2", {0.4});
  EXPECT_EQ(input_error_of([&] { estimate(run, "ssim", "a"); }),
            "\"ssim\" is the name of several metrics here; write one of: ssim,a=1 | ssim,a=2");
}

TEST(Quantities, ThatDoNotExistAreRefusedWithThoseThatDo) {
  ClaimRun run;
  run.times({"a"}, {1.0});
  const RunValues values(run.run());
  const auto error = [&](const char* text) {
    return input_error_of([&] { values.find_quantity(text, {"s.yaml", 2, 5}); });
  };
  EXPECT_NE(error("gahter").find("s.yaml:2:5: unknown quantity \"gahter\"; did you mean "
                                 "\"gather\"? known: total_s, prepare_s"),
            std::string::npos);
  EXPECT_EQ(error("counter.ray"),
            "s.yaml:2:5: unknown counter \"ray\"; did you mean \"rays\"? known: links, rays");
  EXPECT_EQ(error("score.gather"),
            "s.yaml:2:5: unknown metric \"gather\"; known: relmse, flip, mse");
}

TEST(Quantities, SampleSuccessfulRepetitionsAndSeeds) {
  ClaimRun run;
  run.times({"a"}, {1.0, 2.0}).change([](CellRecord& cell) {
    cell.render.status = results::Status::timeout;
  });
  run.scores({"b"}, "relmse", {0.1, 0.2, 0.3});
  const RunValues values(run.run());
  const std::vector<Sample> times = values.samples(0, values.find_quantity("total_s", {}));
  ASSERT_EQ(times.size(), 1U);
  EXPECT_EQ(times[0].value, 1.0);
  const std::vector<Sample> scores = values.samples(1, values.find_quantity("relmse", {}));
  ASSERT_EQ(scores.size(), 3U);
  EXPECT_EQ(scores[2].seed, 3U);
  EXPECT_EQ(results::values_over_frames({{1.0, 1, 0, 0}, {3.0, 1, 0, 1}, {8.0, 2, 0, 0}}),
            (std::vector<double>{2.0, 8.0}));
}

TEST(Quantities, OfAPlannedRunMayTurnOutToBeStages) {
  ClaimRun run;
  run.planned({"a"});
  const RunValues planned(run.run());
  const auto error = [&](const char* text) {
    return input_error_of([&] { planned.check_quantity(text, {}); });
  };
  EXPECT_EQ(error("gather/visibility"), "no error");
  EXPECT_EQ(error("counter.flip"), "no error");
  EXPECT_EQ(error("flip.p99@full"), "no error");
  EXPECT_EQ(error("ssim"), "unknown metric \"ssim\"; known: relmse, flip, mse");
  EXPECT_EQ(error("gather@full"), "unknown metric \"gather\"; known: relmse, flip, mse");
  EXPECT_EQ(error("parameter.depth"), "unknown parameter \"depth\"; known: faces, max_depth");
}

}  // namespace
