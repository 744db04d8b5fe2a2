#include "suites/suite_runner.h"

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using results::CellRecord;
using StoredRun = results::Run;
using results::Status;
using suites::RunOutcome;
using suites::Suite;
using tests::kBlankAndPath;
using tests::Runs;

TEST_F(Runs, MakeImagesRecordsScoresAndMaps) {
  const RunOutcome outcome = run(kBlankAndPath);
  EXPECT_EQ(outcome.cells, 3U);  // b once, pt with two seeds
  EXPECT_EQ(outcome.finished_repetitions, 6U);
  EXPECT_EQ(outcome.new_repetitions, 6U);
  EXPECT_EQ(outcome.failed_cells, 0U);
  EXPECT_EQ(suites::exit_code_of(outcome), 0);
  const StoredRun made = results::load_run(outcome.run_folder);
  EXPECT_EQ(made.info->at("state"), "complete");
  for (const CellRecord& record : made.cells) {
    EXPECT_EQ(record.render.status, Status::ok) << record.render.reason.value_or("");
    EXPECT_EQ(record.run, outcome.run_folder.filename());
    const perception::Image image = perception::read_image(made.folder / record.render.image);
    EXPECT_EQ(perception::pixel_hash(image), record.render.pixel_hash);
    EXPECT_TRUE(record.render.notes.empty());
  }
  // 3 cells x 2 metrics x own and full.
  ASSERT_EQ(made.metrics.size(), 12U);
  for (const results::MetricRecord& score : made.metrics) {
    EXPECT_TRUE(score.value.has_value());
    EXPECT_TRUE(score.noise_floor.has_value());
    const bool is_first_seed = score.cell.find(".s1-") != std::string::npos;
    EXPECT_EQ(!score.map.empty(), is_first_seed) << score.cell;
    if (is_first_seed) {
      EXPECT_TRUE(std::filesystem::exists(made.folder / score.map));
    }
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "results" / "references" /
                                        score.reference_hash / "reference.exr"));
  }
}

TEST_F(Runs, InterleaveTheMethods) {
  const auto records = records_of(run(
      "methods: [{id: a, renderer: blank}, {id: b, renderer: blank, parameters: {radiance: 1}}]\n"
      "measure: {repetitions: 2}\n"));
  std::string order;
  for (const CellRecord& record : records)
    order += record.method + std::to_string(record.repetition);
  EXPECT_EQ(order, "a0b0a1b1");
  const auto blocks = records_of(run(
      "methods: [{id: a, renderer: blank}, {id: b, renderer: blank, parameters: {radiance: 1}}]\n"
      "measure: {repetitions: 2, order: blocks}\n"));
  order.clear();
  for (const CellRecord& record : blocks)
    order += record.method + std::to_string(record.repetition);
  EXPECT_EQ(order, "a0a1b0b1");
}

TEST_F(Runs, ASecondRunFindsNothingToDo) {
  const Suite made = suite(kBlankAndPath);
  const RunOutcome first = tests::run(made, options());
  const auto cells = base::read_text_file(first.run_folder / "cells.jsonl");
  const auto scores = base::read_text_file(first.run_folder / "metrics.jsonl");
  const RunOutcome second = tests::run(made, options());
  EXPECT_EQ(second.run_folder, first.run_folder);
  EXPECT_EQ(second.finished_repetitions, 6U);
  EXPECT_EQ(second.new_repetitions, 0U);
  EXPECT_EQ(base::read_text_file(first.run_folder / "cells.jsonl"), cells);
  EXPECT_EQ(base::read_text_file(first.run_folder / "metrics.jsonl"), scores);

  suites::RunOptions forced = options();
  forced.force = true;
  const RunOutcome third = tests::run(made, forced);
  EXPECT_NE(third.run_folder, first.run_folder);
  EXPECT_EQ(third.new_repetitions, 6U);
}

TEST_F(Runs, AnotherSuiteOrThreadCountIsAnotherRun) {
  const RunOutcome first = run(kBlankAndPath);
  EXPECT_NE(run(std::string(kBlankAndPath) + "summary: changed\n").run_folder, first.run_folder);
  suites::RunOptions two_threads = options();
  two_threads.threads = 2;
  EXPECT_NE(tests::run(suite(kBlankAndPath), two_threads).run_folder, first.run_folder);
}

TEST_F(Runs, PixelsThatDifferFromTheScoredImageAreNoted) {
  const Suite made =
      suite("methods: [{id: b, renderer: blank}]\nmeasure: {warmup: 0, repetitions: 2}\n");
  const RunOutcome stopped = suites::run_suite(
      made, options(),
      [&](const suites::Progress& progress) { suites::interrupt_requested = progress.done == 1; });
  ASSERT_EQ(stopped.finished_repetitions, 1U);
  // The first image as if it had been another one.
  const auto file = stopped.run_folder / "cells.jsonl";
  auto record = nlohmann::ordered_json::parse(base::read_text_file(file));
  record["pixel_hash"] = "0123";
  base::write_text_file(file, record.dump() + "\n");
  suites::interrupt_requested = false;
  const auto records = records_of(tests::run(made, options()));
  ASSERT_EQ(records.size(), 2U);
  ASSERT_EQ(records[1].render.notes.size(), 1U);
  EXPECT_EQ(records[1].render.notes[0], "timed image differs from scored image");
  EXPECT_NE(records[1].render.image, records[0].render.image);
  EXPECT_TRUE(std::filesystem::exists(stopped.run_folder / records[1].render.image));
}

TEST_F(Runs, ASecondHarnessOnTheFolderIsToldWhoHoldsIt) {
  const Suite made = suite(kBlankAndPath);
  const RunOutcome first = tests::run(made, options());
  const results::RunFolder held = results::RunFolder::open_for_writing(first.run_folder);
  const std::string message = tests::input_error_of([&] { tests::run(made, options()); });
  EXPECT_NE(message.find(first.run_folder.string()), std::string::npos) << message;
  EXPECT_NE(message.find(std::to_string(getpid())), std::string::npos) << message;
}

TEST_F(Runs, AFolderOfAnotherSuiteIsRefused) {
  const RunOutcome first = run(kBlankAndPath);
  suites::RunOptions same_folder = options();
  same_folder.run_folder = first.run_folder;
  const std::string message =
      tests::input_error_of([&] { tests::run(suite(blank("normal", "seeds: 1")), same_folder); });
  EXPECT_NE(message.find("holds a run of another suite or profile"), std::string::npos) << message;
}

TEST_F(Runs, AFilterRunsAPartAndTheRestComesLater) {
  const Suite made = suite(kBlankAndPath);
  suites::RunOptions filtered = options();
  filtered.filter = "^b$";
  const RunOutcome part = tests::run(made, filtered);
  EXPECT_EQ(part.cells, 1U);
  EXPECT_EQ(part.new_repetitions, 2U);
  const RunOutcome rest = tests::run(made, options());
  EXPECT_EQ(rest.run_folder, part.run_folder);
  EXPECT_EQ(rest.new_repetitions, 4U);
  // A part done again takes nothing away from what the run says it planned.
  tests::run(made, filtered);
  const StoredRun stored = results::load_run(part.run_folder);
  EXPECT_EQ(stored.info->at("planned_cells").size(), 3U);
  EXPECT_EQ(stored.info->at("references").size(), 2U);
  filtered.filter = "no such cell";
  EXPECT_EQ(suites::exit_code_of(tests::run(made, filtered)), 4);
}

TEST(ExitCodes, FollowTheirPrecedence) {
  RunOutcome outcome;
  EXPECT_EQ(suites::exit_code_of(outcome), 4);
  outcome.cells = 2;
  EXPECT_EQ(suites::exit_code_of(outcome), 0);
  outcome.failed_cells = 1;
  EXPECT_EQ(suites::exit_code_of(outcome), 3);
  outcome.was_interrupted = true;
  EXPECT_EQ(suites::exit_code_of(outcome), 130);
}

}  // namespace
