#include "results/psychophysics/psychophysics_run.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/result_store.h"
#include "tests/expect_error.h"
#include "tests/results/psychophysics/synthetic_experiment.h"
#include "tests/temporary_folder.h"

namespace results::psychophysics {
namespace {

/// Writes a run's files as the runner does.
void store(const PsychophysicsRun& run) {
  RunFolder folder = RunFolder::open_for_writing(run.folder);
  nlohmann::ordered_json info = *run.info;
  info["experiments"] = {to_json(run.experiments[0])};
  info["models"] = nlohmann::ordered_json::array();
  for (const VisionModel& model : run.models) {
    info["models"].push_back({{"id", model.id}, {"kind", model.kind}, {"summary", model.summary}});
  }
  folder.write_run_json(info);
  folder.write_resolved_suite(run.resolved_suite);
  for (const PredictionRecord& record : run.predictions) folder.append_cell(to_json(record));
}

TEST(PsychophysicsRun, ComesBackAsItWasStored) {
  const tests::TemporaryFolder folder;
  const PsychophysicsRun stored = tests::synthetic_experiment(folder.path());
  store(stored);
  EXPECT_EQ(run_kind(folder.path()), "psychophysics");
  const PsychophysicsRun read = load_psychophysics_run(folder.path());
  EXPECT_EQ(to_json(read.experiments[0]), to_json(stored.experiments[0]));
  ASSERT_EQ(read.predictions.size(), stored.predictions.size());
  for (std::size_t i = 0; i < read.predictions.size(); ++i) {
    EXPECT_EQ(to_json(read.predictions[i]), to_json(stored.predictions[i]));
  }
  EXPECT_EQ(read.models[1].summary, "6 dB more");
  EXPECT_EQ(read.find("edges", "p10", "lax")->threshold_db, -22.0);
  EXPECT_EQ(read.find("edges", "p11", "lax"), nullptr);
}

TEST(PsychophysicsRun, TheLastAnswerCountsAndACutLineIsCounted) {
  const tests::TemporaryFolder folder;
  PsychophysicsRun run = tests::synthetic_experiment(folder.path());
  run.predictions.push_back(tests::prediction("p1", "exact", -11.0));
  store(run);
  std::ofstream(folder.path() / "cells.jsonl", std::ios::app) << "{\"schema\":1,\"run";
  const PsychophysicsRun read = load_psychophysics_run(folder.path());
  EXPECT_EQ(read.find("edges", "p1", "exact")->threshold_db, -11.0);
  EXPECT_EQ(read.predictions.size(), run.predictions.size() - 1);
  EXPECT_EQ(read.unreadable_lines, 1U);
}

TEST(PsychophysicsRun, RunsOfTheOtherKindAreRefused) {
  const tests::TemporaryFolder folder;
  store(tests::synthetic_experiment(folder.path()));
  tests::expect_error<base::InputError>(
      [&] { load_run(folder.path()); },
      folder.path().string() + ": a run of kind psychophysics; accepted here: a run of images");
  const tests::TemporaryFolder images;
  RunFolder::open_for_writing(images.path()).write_run_json({{"schema", 1}});
  tests::expect_error<base::InputError>(
      [&] { load_psychophysics_run(images.path()); },
      images.path().string() + ": a run of kind images; accepted here: psychophysics");
}

TEST(Experiment, NamesWhatItCannotRead) {
  const PsychophysicsRun run = tests::synthetic_experiment("/nowhere");
  nlohmann::ordered_json json = to_json(run.experiments[0]);
  json["phenomena"][0]["kind"] = "slopes";
  tests::expect_error_with<base::InputError>(
      [&] { experiment_from_json(json); },
      {"unknown kind of phenomenon \"slopes\"; did you mean \"slope\"?"});
  json["stimuli"][0].erase("observed_db");
  tests::expect_error<base::InputError>([&] { experiment_from_json(json); },
                                        "stimulus: field \"observed_db\" is missing");
}

}  // namespace
}  // namespace results::psychophysics
