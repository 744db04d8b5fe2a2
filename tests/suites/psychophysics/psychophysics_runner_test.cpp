#include "suites/psychophysics/psychophysics_runner.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "perception/image_file.h"
#include "results/psychophysics/psychophysics_run.h"
#include "suites/interruption.h"
#include "tests/expect_input_error.h"
#include "tests/suites/psychophysics/small_suite.h"
#include "tests/temporary_folder.h"

namespace suites::psychophysics {
namespace {

using results::psychophysics::load_psychophysics_run;

RunOptions options_for(const tests::TemporaryFolder& folder) {
  RunOptions options;
  options.results_root = folder.path();
  return options;
}

TEST(PsychophysicsRunner, AsksEveryModelAboutEveryStimulusOnce) {
  const tests::TemporaryFolder folder;
  const PsychophysicsSuite suite = tests::parsed(tests::kSmallSuite);
  const RunOutcome outcome = run_psychophysics(suite, options_for(folder), nullptr);
  EXPECT_EQ(outcome.cells, 15U);
  EXPECT_EQ(outcome.new_repetitions, 15U);
  EXPECT_EQ(outcome.failed_cells, 0U);
  EXPECT_EQ(outcome.skipped_cells, 6U);  // csf 2, filter 2, tvi 2
  EXPECT_EQ(exit_code_of(outcome), 0);
  const auto run = load_psychophysics_run(outcome.run_folder);
  EXPECT_EQ(run.predictions.size(), 15U);
  EXPECT_EQ(run.experiments[0].stimuli[1].picture, "images/patches/masked.png");
  const perception::Image picture =
      perception::read_image(outcome.run_folder / "images/patches/masked.png");
  EXPECT_EQ(picture.width_px, 60);

  const RunOutcome again = run_psychophysics(suite, options_for(folder), nullptr);
  EXPECT_EQ(again.run_folder, outcome.run_folder);
  EXPECT_EQ(again.new_repetitions, 0U);
  EXPECT_EQ(again.finished_repetitions, 15U);
}

TEST(PsychophysicsRunner, AFilterLeavesTheRestForLater) {
  const tests::TemporaryFolder folder;
  const PsychophysicsSuite suite = tests::parsed(tests::kSmallSuite);
  RunOptions options = options_for(folder);
  options.filter = "spot.tvi|plain.csf";
  const RunOutcome part = run_psychophysics(suite, options, nullptr);
  EXPECT_EQ(part.cells, 2U);
  EXPECT_EQ(part.new_repetitions, 2U);
  const RunOutcome rest = run_psychophysics(suite, options_for(folder), nullptr);
  EXPECT_EQ(rest.run_folder, part.run_folder);
  EXPECT_EQ(rest.new_repetitions, 13U);
  EXPECT_EQ(tests::input_error_of([&] {
              plan_questions(suite, "((");
            }).find("--filter \"((\" is not a regular expression"),
            0U);
}

TEST(PsychophysicsRunner, AnInterruptedRunKeepsItsAnswersAndGoesOn) {
  const tests::TemporaryFolder folder;
  const PsychophysicsSuite suite = tests::parsed(tests::kSmallSuite);
  const RunOutcome part =
      run_psychophysics(suite, options_for(folder), [](const Progress& progress) {
        if (progress.done == 4) interrupt_requested = true;
      });
  interrupt_requested = false;
  EXPECT_TRUE(part.was_interrupted);
  EXPECT_EQ(exit_code_of(part), 130);
  EXPECT_EQ(load_psychophysics_run(part.run_folder).predictions.size(), part.new_repetitions);
  EXPECT_GE(part.new_repetitions, 4U);
  const RunOutcome rest = run_psychophysics(suite, options_for(folder), nullptr);
  EXPECT_EQ(rest.run_folder, part.run_folder);
  EXPECT_EQ(rest.new_repetitions + part.new_repetitions, 15U);
}

TEST(PsychophysicsRunner, AnswersAreTheSameForAnyNumberOfThreads) {
  const PsychophysicsSuite suite = tests::parsed(tests::kSmallSuite);
  std::vector<std::optional<double>> answers[2];
  for (const int threads : {1, 4}) {
    const tests::TemporaryFolder folder;
    RunOptions options = options_for(folder);
    options.threads = threads;
    const RunOutcome outcome = run_psychophysics(suite, options, nullptr);
    for (const auto& record : load_psychophysics_run(outcome.run_folder).predictions) {
      answers[threads == 1 ? 0 : 1].push_back(record.threshold_db);
    }
  }
  EXPECT_EQ(answers[0], answers[1]);
}

}  // namespace
}  // namespace suites::psychophysics
