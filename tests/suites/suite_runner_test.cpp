#include "suites/suite_runner.h"

#include <signal.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "renderers/scene/scene_file.h"
#include "results/result_store.h"
#include "suites/reference_images.h"
#include "tests/expect_input_error.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace {

using results::CellRecord;
using StoredRun = results::Run;
using results::Status;
using suites::RunOutcome;
using suites::Suite;

constexpr const char* kBlankAndPath =
    "methods: [{id: b, renderer: blank, parameters: {radiance: 0.25}}, {id: pt, renderer: path}]\n"
    "budgets: [{samples: 4}]\n"
    "measure: {seeds: 2, repetitions: {min: 2, max: 2}}\n"
    "metrics: [relmse, ssim]\n";

class Runs : public testing::Test {
 protected:
  ~Runs() override { suites::interrupt_requested = false; }

  Suite suite(const std::string& rest) {
    return tests::suite_from(folder_.path(), tests::kSuiteHead + rest);
  }
  suites::RunOptions options() { return tests::run_options(folder_.path()); }
  RunOutcome run(const std::string& rest) { return tests::run(suite(rest), options()); }

  /// One method of `blank` that behaves as named.
  static std::string blank(const std::string& behaviour, const std::string& measure) {
    return "methods: [{id: b, renderer: blank, parameters: {behaviour: \"" + behaviour +
           "\"}}]\nmeasure: {warmup: 0, " + measure + "}\n";
  }
  static std::vector<CellRecord> records_of(const RunOutcome& outcome) {
    return results::load_run(outcome.run_folder).cells;
  }
  static std::string state_of(const RunOutcome& outcome) {
    return results::load_run(outcome.run_folder).info->at("state").get<std::string>();
  }
  static std::size_t line_count(const std::filesystem::path& file) {
    const std::string text = base::read_text_file(file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  tests::TemporaryFolder folder_;
};

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

TEST_F(Runs, MethodsAreScoredAgainstTheirOwnTransportAndAgainstAllLight) {
  const RunOutcome outcome =
      run("methods: [{id: direct, renderer: path, parameters: {transport: direct}}]\n"
          "budgets: [{samples: 64}]\nmetrics: [relmse]\n");
  const StoredRun made = results::load_run(outcome.run_folder);
  std::map<std::string, double> value;
  for (const auto& score : made.metrics) value[score.against] = score.value.value_or(-1.0);
  ASSERT_EQ(value.size(), 2U);
  // Indirect light is missing: what the viewer misses is far more than the method's own noise.
  EXPECT_GT(value["full"], 10.0 * value["own"]);
  EXPECT_EQ(made.info->at("references").size(), 2U);
}

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

TEST_F(Runs, ARendererThatCannotMakeTheReferenceIsRefusedBeforeTheRun) {
  Suite made = suite("methods: [{id: b, renderer: blank}]\nmetrics: [relmse]\n");
  made.scenes[0].reference.renderer = "blank";
  // `blank` claims direct light only: there is no reference of all light by it.
  const std::string message = tests::input_error_of([&] { tests::run(made, options()); });
  EXPECT_EQ(message.find("reference: renderer \"blank\" cannot render transport full"), 0U);
}

TEST_F(Runs, AReferenceThatCannotBeReadIsToldAndTheTimesAreKept) {
  const Suite made = suite("methods: [{id: b, renderer: blank}]\nmetrics: [relmse]\n");
  tests::run(made, options());
  for (const auto& entry :
       std::filesystem::directory_iterator(folder_.path() / "results" / "references")) {
    std::filesystem::resize_file(entry.path() / "reference.exr", 100);
  }
  suites::RunOptions forced = options();
  forced.force = true;
  const RunOutcome outcome = tests::run(made, forced);
  EXPECT_EQ(outcome.failed_references, 2U);
  EXPECT_EQ(outcome.finished_repetitions, 1U);
  EXPECT_EQ(suites::exit_code_of(outcome), 3);
  const StoredRun stored = results::load_run(outcome.run_folder);
  EXPECT_TRUE(stored.metrics.empty());
  for (const auto& reference : stored.info->at("references")) {
    EXPECT_NE(reference.at("reason").get<std::string>().find("reference.exr"), std::string::npos);
  }
}

TEST_F(Runs, EvaluationMakesOnlyWhatIsMissing) {
  const Suite made =
      suite("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\nmetrics: [relmse]\n");
  const RunOutcome first = tests::run(made, options());
  const double before = results::load_run(first.run_folder).metrics.at(0).value.value_or(0);
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 0U);
  suites::RunOptions forced = options();
  forced.force = true;
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, forced, {}), 2U);
  EXPECT_EQ(results::load_run(first.run_folder).metrics.at(0).value.value_or(0), before);
  Suite more = made;
  more.metrics.push_back(metrics::parse_metric_choice("ssim", {}));
  EXPECT_EQ(suites::evaluate_run(more, first.run_folder, options(), {}), 2U);
}

TEST_F(Runs, AReferenceWithMoreSamplesMakesScoresAnew) {
  const char* methods =
      "methods: [{id: pt, renderer: path}, {id: b, renderer: blank}]\n"
      "budgets: [{samples: 4}]\nmetrics: [relmse]\n";
  suites::RunOptions part = options();
  part.filter = "pt";
  const Suite made = suite(methods);
  const RunOutcome first = tests::run(made, part);
  const double before = results::load_run(first.run_folder).metrics.at(0).value.value_or(0);
  const auto scene = renderers::scene::read_scene_file(made.scenes[0].file).at_frame(0);
  suites::ReferenceKey key;
  key.scene = &scene;
  key.size_px = made.scenes[0].size_px;
  suites::ReferenceStore(options().results_root).extend(key, 64, 1, {});
  tests::run(made, options());
  const StoredRun again = results::load_run(first.run_folder);
  EXPECT_EQ(again.metrics.at(0).cell.find("walls.pt"), 0U);
  EXPECT_NE(again.metrics.at(0).value.value_or(0), before);
}

TEST_F(Runs, AFinishedRunIsScoredAnewOnceItsReferenceHasMoreSamples) {
  const char* methods =
      "methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\nmetrics: [relmse]\n";
  const RunOutcome first = run(methods);
  const results::MetricRecord before = results::load_run(first.run_folder).metrics.at(0);
  EXPECT_EQ(run(methods).new_repetitions, 0U);
  const Suite made = suite(methods);
  const auto scene = renderers::scene::read_scene_file(made.scenes[0].file).at_frame(0);
  suites::ReferenceKey key;
  key.scene = &scene;
  key.size_px = made.scenes[0].size_px;
  suites::ReferenceStore(options().results_root).extend(key, 64, 1, {});
  const RunOutcome again = run(methods);
  EXPECT_EQ(again.new_repetitions, 0U);
  const StoredRun after = results::load_run(again.run_folder);
  EXPECT_EQ(after.folder, first.run_folder);
  EXPECT_NE(after.metrics.at(0).value, before.value);
  EXPECT_LT(after.metrics.at(0).noise_floor.value(), before.noise_floor.value());
  EXPECT_EQ(after.info->at("references").at(0).at("pixel_hash"),
            after.metrics.at(0).reference_pixel_hash);
}

TEST_F(Runs, TheNoiseFloorOfRelmseIsTheRelativeVarianceOfTheReference) {
  const RunOutcome outcome =
      run("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\nmetrics: [relmse]\n");
  const results::MetricRecord score = results::load_run(outcome.run_folder).metrics.at(0);
  const auto file = perception::read_image_file(folder_.path() / "results" / "references" /
                                                score.reference_hash / "reference.exr");
  const perception::Image& mean = file.parts.at(0).image;
  const auto variance = std::find_if(file.parts.begin(), file.parts.end(),
                                     [](const auto& part) { return part.name == "variance"; });
  ASSERT_NE(variance, file.parts.end());
  double expected = 0.0;
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
    const auto r = static_cast<double>(mean.pixels[i]);
    expected += static_cast<double>(variance->image.pixels[i]) / (r * r + 0.01);
  }
  expected /= static_cast<double>(mean.pixels.size());
  // One draw of unit variance per pixel, weighted very unevenly: a factor of two.
  EXPECT_GT(score.noise_floor.value(), 0.5 * expected);
  EXPECT_LT(score.noise_floor.value(), 2.0 * expected);
}

TEST_F(Runs, ADamagedImageCostsItsOwnScoresOnly) {
  const char* methods =
      "methods: [{id: pt, renderer: path}, {id: b, renderer: blank}]\n"
      "budgets: [{samples: 4}]\nmetrics: [relmse]\n";
  const RunOutcome first = run(methods);
  const StoredRun made = results::load_run(first.run_folder);
  const auto image = made.folder / made.cells.at(0).render.image;
  std::filesystem::resize_file(image, std::filesystem::file_size(image) / 2);
  std::filesystem::remove(made.folder / "metrics.jsonl");
  const RunOutcome again = run(methods);
  EXPECT_EQ(again.failed_scores, 1U);
  EXPECT_EQ(suites::exit_code_of(again), 3);
  const StoredRun after = results::load_run(again.run_folder);
  EXPECT_EQ(after.metrics.size(), 2U);
  const auto reason = after.info->at("score_failures").at(0).get<std::string>();
  EXPECT_NE(reason.find(image.string()), std::string::npos) << reason;
}

/// The same for the image and for a checkpoint, which is written while the renderer works.
class RunsIntoAFullFolder : public Runs, public testing::WithParamInterface<const char*> {};

TEST_P(RunsIntoAFullFolder, StopAndAreNoFaultOfTheMethod) {
  const Suite made = suite("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\n");
  const auto scene = renderers::scene::read_scene_file(made.scenes[0].file).at_frame(0);
  const std::string cell = suites::make_plan(made, {scene}).cells.at(0).name;
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
