#include <cmath>
#include <map>
#include <thread>

#include "renderers/scene/scene_file.h"
#include "results/run_summary.h"
#include "results/tables.h"
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

TEST_F(Runs, ACrashIsARecordAndTheWorkerIsReplaced) {
  const RunOutcome outcome = run(blank("crash", "repetitions: 2"));
  const auto records = records_of(outcome);
  ASSERT_EQ(records.size(), 2U);
  for (const CellRecord& record : records) {
    EXPECT_EQ(record.render.status, Status::crash);
    EXPECT_EQ(record.render.reason, "signal 6 (Aborted)");
    EXPECT_EQ(record.render.renderer, "blank");
    EXPECT_EQ(record.render.width_px, 16);
    EXPECT_TRUE(record.render.image.empty());
  }
  EXPECT_EQ(outcome.failed_cells, 1U);
  EXPECT_EQ(suites::exit_code_of(outcome), 3);
  EXPECT_EQ(state_of(outcome), "complete");
}

TEST_F(Runs, OneMethodsCrashLeavesTheOthersAlone) {
  const RunOutcome outcome =
      run("methods: [{id: bad, renderer: blank, parameters: {behaviour: crash}},\n"
          "          {id: good, renderer: blank}]\nmeasure: {repetitions: 3}\n");
  std::map<std::string, int> ok;
  for (const CellRecord& record : records_of(outcome)) {
    ok[record.method] += record.render.status == Status::ok ? 1 : 0;
  }
  EXPECT_EQ(ok["good"], 3);
  EXPECT_EQ(ok["bad"], 0);
}

TEST_F(Runs, AHangIsATimeoutAndIsNotRepeated) {
  const RunOutcome outcome = run(blank("hang", "repetitions: 5, timeout: 200ms"));
  const auto records = records_of(outcome);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].render.status, Status::timeout);
  EXPECT_EQ(records[0].render.reason, "no answer within 200 ms");
}

TEST_F(Runs, TooMuchMemoryIsARecord) {
  const auto records = records_of(run(blank("allocate", "memory: 300MiB")));
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].render.status, Status::out_of_memory);
}

/// A run with what cannot be done goes on and says so once per cell.
TEST_F(Runs, WhatARendererRefusesIsUnsupportedAndTheRestIsDone) {
  const RunOutcome outcome =
      run("methods: [{id: odd, renderer: light-propagation, parameters: {light_points: 48}},\n"
          "          {id: good, renderer: blank}]\nmeasure: {repetitions: 3}\n");
  const StoredRun made = results::load_run(outcome.run_folder);
  ASSERT_EQ(made.cells.size(), 4U);
  for (const CellRecord& record : made.cells) {
    if (record.method == "good") {
      EXPECT_EQ(record.render.status, Status::ok);
      continue;
    }
    EXPECT_EQ(record.render.status, Status::unsupported);
    EXPECT_EQ(record.render.reason,
              "light-propagation: light_points is 48; accepted: powers of two");
  }
  EXPECT_EQ(outcome.failed_cells, 0U);
  EXPECT_EQ(outcome.skipped_cells, 1U);
  EXPECT_EQ(suites::exit_code_of(outcome), 0);
  const results::RunSummary summary = results::summarize(made);
  EXPECT_EQ(results::format_statuses(summary.rows.at(0)), "unsupported");
}

TEST_F(Runs, APictureThatCannotFitIsARecordAndTheRestIsDone) {
  Suite made = suite("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 1}]\n");
  made.scenes.push_back(made.scenes.front());
  made.scenes.back().id = "huge";
  made.scenes.back().size_px = {65536, 65536};
  made.measure.min_repetitions = made.measure.max_repetitions = 2;
  const RunOutcome outcome = tests::run(made, options());
  const auto records = records_of(outcome);
  ASSERT_EQ(records.size(), 3U);
  for (const CellRecord& record : records) {
    const bool is_huge = record.scene == "huge";
    EXPECT_EQ(record.render.status, is_huge ? Status::out_of_memory : Status::ok);
    const std::string reason = record.render.reason.value_or("");
    EXPECT_EQ(reason.find("a picture of 65536x65536 pixels takes at least ") == 0, is_huge);
  }
  EXPECT_EQ(outcome.failed_cells, 1U);
  EXPECT_EQ(suites::exit_code_of(outcome), 3);
}

TEST_F(Runs, PixelsThatAreNoNumbersAreARecordWithoutAScore) {
  const RunOutcome outcome = run(blank("nan", "seeds: 1") + "metrics: [relmse]\n");
  const StoredRun made = results::load_run(outcome.run_folder);
  ASSERT_EQ(made.cells.size(), 1U);
  EXPECT_EQ(made.cells[0].render.status, Status::non_finite);
  EXPECT_FALSE(made.cells[0].render.image.empty());
  ASSERT_EQ(made.metrics.size(), 2U);
  EXPECT_FALSE(made.metrics[0].value.has_value());
  EXPECT_EQ(suites::exit_code_of(outcome), 3);
}

TEST_F(Runs, AnExceptionIsARecord) {
  const auto records = records_of(run(blank("exception", "seeds: 1")));
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].render.status, Status::crash);
  EXPECT_EQ(records[0].render.reason, "exception: blank: asked to fail by an exception");
}

TEST_F(Runs, ACutLineIsDoneAgainAndEverythingElseIsKept) {
  const Suite made = suite(kBlankAndPath);
  const RunOutcome first = tests::run(made, options());
  const auto file = first.run_folder / "cells.jsonl";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 40);
  const RunOutcome second = tests::run(made, options());
  EXPECT_EQ(second.run_folder, first.run_folder);
  EXPECT_EQ(second.new_repetitions, 1U);
  EXPECT_EQ(second.finished_repetitions, 6U);
  const StoredRun again = results::load_run(first.run_folder);
  EXPECT_EQ(again.cells.size(), 6U);
  EXPECT_EQ(again.unreadable_lines, 1U);
}

TEST_F(Runs, AnInterruptKeepsWhatIsFinishedAndTheNextRunGoesOn) {
  const Suite made = suite(
      "methods: [{id: b, renderer: blank, parameters: {sleep_s: 0.02}}]\n"
      "measure: {warmup: 0, repetitions: 6}\n");
  std::size_t finished = 0;
  const RunOutcome stopped =
      suites::run_suite(made, options(), [&](const suites::Progress& progress) {
        finished = std::max(finished, progress.done);
        if (progress.done == 2) suites::interrupt_requested = true;
      });
  EXPECT_TRUE(stopped.was_interrupted);
  EXPECT_EQ(suites::exit_code_of(stopped), 130);
  EXPECT_EQ(stopped.finished_repetitions, 2U);
  EXPECT_EQ(state_of(stopped), "interrupted");
  EXPECT_EQ(line_count(stopped.run_folder / "cells.jsonl"), 2U);

  suites::interrupt_requested = false;
  const RunOutcome resumed = tests::run(made, options());
  EXPECT_EQ(resumed.run_folder, stopped.run_folder);
  EXPECT_EQ(resumed.new_repetitions, 4U);
  EXPECT_EQ(state_of(resumed), "complete");
  int next = 0;
  for (const CellRecord& record : records_of(resumed)) EXPECT_EQ(record.repetition, next++);
}

TEST_F(Runs, WhatGoesOnKnowsItsScores) {
  const Suite made = suite(
      "methods: [{id: b, renderer: blank}, {id: c, renderer: blank}]\nmetrics: [mse, mae]\n"
      "measure: {warmup: 0, repetitions: 2, order: blocks}\n");
  std::size_t before = 0;
  suites::run_suite(made, options(), [&](const suites::Progress& progress) {
    before = progress.total;
    if (progress.activity.starts_with("walls c")) suites::interrupt_requested = true;
  });
  suites::interrupt_requested = false;
  std::vector<std::size_t> totals;
  std::size_t done = 0;
  suites::run_suite(made, options(), [&](const suites::Progress& progress) {
    totals.push_back(progress.total);
    done = progress.done;
  });
  EXPECT_LT(totals.front(), before);  // some is done
  EXPECT_EQ(totals.front(), totals.back());
  EXPECT_EQ(done, totals.back());
}

/// A run that was stopped and whose records then say that another device than the CPU made them.
class RunsOfAnotherDevice : public Runs {
 protected:
  void stop_after_two(const Suite& made) {
    stopped_ = suites::run_suite(made, options(), [&](const suites::Progress& progress) {
      if (progress.done == 2) suites::interrupt_requested = true;
    });
    suites::interrupt_requested = false;
    const auto file = stopped_.run_folder / "cells.jsonl";
    std::string text = base::read_text_file(file);
    replace_all(text, "\"device\":\"cpu\"", "\"device\":\"llvmpipe\"");
    replace_all(text, "\"gl_platform\":null", "\"gl_platform\":\"egl-surfaceless\"");
    base::write_text_file(file, text);
  }
  static void replace_all(std::string& text, const std::string& from, const std::string& to) {
    std::size_t count = 0;
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
      ++count;
    }
    ASSERT_EQ(count, 2U) << from;
  }
  RunOutcome stopped_;
};

TEST_F(RunsOfAnotherDevice, AreNotContinuedByThisOne) {
  // Under a time budget repetitions differ in their pixels: the third one stores an image, too.
  const Suite made = suite(
      "methods: [{id: pt, renderer: path}]\nbudgets: [{time: 20ms}]\n"
      "measure: {warmup: 0, repetitions: 6, order: blocks}\n");
  stop_after_two(made);
  const RunOutcome resumed = tests::run(made, options());
  EXPECT_EQ(resumed.run_folder, stopped_.run_folder);
  const auto records = records_of(resumed);
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[1].render.status, Status::ok);
  const results::RenderRecord& refused = records[2].render;
  EXPECT_EQ(refused.status, Status::unsupported);
  EXPECT_EQ(refused.reason,
            "the device changed: this cell was measured on llvmpipe (egl-surfaceless), this "
            "repetition ran on cpu; --force starts a new run, --device forces a platform");
  EXPECT_EQ(refused.device, "cpu");
  EXPECT_FALSE(refused.gl_platform.has_value());
  EXPECT_FALSE(std::isfinite(refused.total_s));
  EXPECT_TRUE(refused.image.empty());
  EXPECT_TRUE(refused.stages.empty());
  const auto images = resumed.run_folder / "images" / records[2].cell;
  EXPECT_TRUE(std::filesystem::exists(images / "frame.exr"));
  EXPECT_FALSE(std::filesystem::exists(images / "frame-r002.exr"));
  EXPECT_EQ(resumed.failed_cells, 0U);
  EXPECT_EQ(resumed.skipped_cells, 1U);
  EXPECT_EQ(tests::run(made, options()).new_repetitions, 0U);

  const StoredRun stored = results::load_run(resumed.run_folder);
  const results::RunSummary summary = results::summarize(stored);
  ASSERT_EQ(summary.rows.size(), 1U);
  ASSERT_TRUE(summary.rows[0].total_s.has_value());
  EXPECT_EQ(summary.rows[0].total_s->count, 2U);
}

TEST_F(RunsOfAnotherDevice, EndASequenceWithItsFirstFrame) {
  const Suite made = tests::suite_from(
      folder_.path(), tests::kSequenceHead +
                          "methods: [{id: b, renderer: blank, parameters: {radiance: 0.5}}]\n"
                          "measure: {warmup: 0, repetitions: 3}\n");
  const RunOutcome first = tests::run(made, options());
  const auto file = first.run_folder / "cells.jsonl";
  const std::string all = base::read_text_file(file);
  std::size_t end = 0;
  for (int line = 0; line < 4; ++line) end = all.find('\n', end) + 1;
  std::string text = all.substr(0, end);
  for (auto at = text.find("\"cpu\""); at != std::string::npos; at = text.find("\"cpu\"")) {
    text.replace(at, 5, "\"llvmpipe\"");
  }
  base::write_text_file(file, text);
  const auto records = records_of(tests::run(made, options()));
  ASSERT_EQ(records.size(), 5U);
  EXPECT_EQ(records[4].repetition, 1);
  EXPECT_EQ(records[4].render.frame, 0);
  EXPECT_EQ(records[4].render.status, Status::unsupported);
}

TEST_F(Runs, AnInterruptStopsAWorkerThatHangs) {
  const Suite made = suite(blank("hang", "seeds: 1"));
  std::thread user([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    suites::interrupt_requested = true;
  });
  const RunOutcome outcome = tests::run(made, options());
  user.join();
  EXPECT_TRUE(outcome.was_interrupted);
  EXPECT_EQ(outcome.finished_repetitions, 0U);
}

/// The same for the image and for a checkpoint, which is written while the renderer works.
class RunsIntoAFullFolder : public Runs, public testing::WithParamInterface<const char*> {};

TEST_P(RunsIntoAFullFolder, StopAndAreNoFaultOfTheMethod) {
  const Suite made = suite("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\n");
  const auto scenes = suites::load_scenes(made);
  const std::string cell = suites::make_plan(made, scenes).cells.at(0).name;
  suites::RunOptions chosen = options();
  chosen.run_folder = folder_.path() / "results" / "runs" / "x" / "here";
  // A folder where the image should be: no image can be renamed to its place.
  const auto obstacle = chosen.run_folder / "images" / cell / GetParam();
  std::filesystem::create_directories(obstacle);
  const std::string message = tests::input_error_of([&] { tests::run(made, chosen); });
  EXPECT_NE(message.find(std::string(GetParam()) + ": cannot be written: "), std::string::npos)
      << message;
  EXPECT_TRUE(results::load_run(chosen.run_folder).cells.empty());
  std::filesystem::remove(obstacle);
  const RunOutcome again = tests::run(made, chosen);
  EXPECT_EQ(again.new_repetitions, 1U);
  EXPECT_EQ(suites::exit_code_of(again), 0);
}

INSTANTIATE_TEST_SUITE_P(Files, RunsIntoAFullFolder,
                         testing::Values("frame.exr", "checkpoint-000.exr"));

TEST_F(Runs, UnsupportedCellsAreRecordsWithoutAWorker) {
  Suite made = suite("methods: [{id: b, renderer: blank}]\n");
  renderers::RendererInfo poor = *made.methods[0].choice.info;
  poor.supports.clear();
  made.methods[0].choice.info = &poor;
  suites::RunOptions no_worker = options();
  const RunOutcome outcome = tests::run(made, no_worker);
  const auto records = records_of(outcome);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].render.status, Status::unsupported);
  EXPECT_EQ(records[0].render.reason, "renderer \"blank\" does not support point-light");
  EXPECT_EQ(outcome.skipped_cells, 1U);
  EXPECT_EQ(suites::exit_code_of(outcome), 4);
}

TEST_F(Runs, LogsLieInTheCellAndEmptyOnesAreRemoved) {
  const RunOutcome outcome = run(blank("print", "seeds: 1"));
  const auto records = records_of(outcome);
  ASSERT_EQ(records.size(), 1U);
  const auto cell = outcome.run_folder / "images" / records[0].cell;
  EXPECT_GT(std::filesystem::file_size(cell / "stdout.log"), 1000U);
  EXPECT_FALSE(std::filesystem::exists(cell / "stderr.log"));
}

}  // namespace
