#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "perception/base/child_process.h"
#include "results/result_store.h"
#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

class RunVerb : public ProgramTest {
 protected:
  std::vector<std::string> ad_hoc(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run",       "--scene",  "cornell-box-spot",
                                   "--method",  "path",     "--method",
                                   "blank",     "--size",   "16x16",
                                   "--samples", "2",        "--reference-samples",
                                   "16",        "--metric", "relmse"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  static std::string read(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
};

TEST_F(RunVerb, RunsScoresAndReports) {
  const auto json = discern_json(ad_hoc(), "run");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["cells"], 2);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_EQ(json["finished_repetitions"], 2);
  EXPECT_EQ(json["interrupted"], false);
  const std::filesystem::path run = json["run"].get<std::string>();
  EXPECT_TRUE(std::filesystem::exists(json["report"].get<std::string>()));
  EXPECT_EQ(schema_problems("cell", read(run / "cells.jsonl")), "");
  EXPECT_EQ(schema_problems("metric", read(run / "metrics.jsonl")), "");
  // Both methods against own and full.
  std::istringstream lines(read(run / "metrics.jsonl"));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) ++count;
  EXPECT_EQ(count, 4U);
  const auto info = nlohmann::json::parse(read(run / "run.json"));
  EXPECT_NE(info.dump().find("--reference-samples 16"), std::string::npos);
}

TEST_F(RunVerb, PrintsTheTableAndThePathsForAPerson) {
  const auto result = discern(ad_hoc());
  EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
  for (const char* part : {"cornell-box-spot", "path", "blank", "2 cells, 0 failed", "report  "}) {
    EXPECT_NE(result.stdout_text.find(part), std::string::npos) << part << result.stdout_text;
  }
  EXPECT_NE(result.stderr_text.find("[0/"), std::string::npos) << result.stderr_text;
  EXPECT_EQ(result.stderr_text.find('\x1b'), std::string::npos);
}

TEST_F(RunVerb, ReportAndEvalWorkOnAStoredRun) {
  const auto run = discern_json(ad_hoc(), "run");
  std::filesystem::remove(run["report"].get<std::string>());
  const auto report = discern_json({"report", "last"}, "report");
  EXPECT_EQ(report["report"], run["report"]);
  EXPECT_EQ(report["repetitions"], 2);
  EXPECT_TRUE(std::filesystem::exists(report["report"].get<std::string>()));
  const auto eval = discern_json({"eval", "last", "--metric", "mae"}, "eval");
  EXPECT_EQ(eval["scores"], 4);
  const auto text = discern({"report", "ad-hoc"});
  EXPECT_EQ(text.stdout_text, report["report"].get<std::string>() + "\n");
}

TEST_F(RunVerb, AReportIsSplitOnDemandAndSaysSo) {
  const auto run = discern_json(ad_hoc(), "run");
  const std::filesystem::path data =
      std::filesystem::path(run["report"].get<std::string>()).parent_path() / "data";
  EXPECT_EQ(discern_json({"report", "last"}, "report")["split"], false);
  EXPECT_FALSE(std::filesystem::exists(data));
  const auto split = discern_json({"report", "last", "--split"}, "report");
  EXPECT_EQ(split["split"], true);
  EXPECT_GT(split["data_bytes"], 0);
  EXPECT_TRUE(std::filesystem::exists(data / "f0.js"));
  const auto text = discern({"report", "last", "--split"});
  EXPECT_NE(text.stderr_text.find("of images are in " + data.string()), std::string::npos)
      << text.stderr_text;
  EXPECT_EQ(discern_json({"report", "last", "--one-file"}, "report")["split"], false);
  EXPECT_FALSE(std::filesystem::exists(data));
  EXPECT_EQ(discern({"report", "last", "--split", "--one-file"}).exit.code, 2);
}

TEST_F(RunVerb, AFilterSelectsCells) {
  const auto json = discern_json(ad_hoc({"--filter", "blank"}), "run");
  EXPECT_EQ(json["cells"], 1);
  EXPECT_EQ(json["finished_repetitions"], 1);
}

TEST_F(RunVerb, AFailedCellIsCountedAndDecidesTheExitCode) {
  const std::string scene = write_text("bright.yaml", R"(schema: 1
scene: bright
camera: {position: [0, 0, -2], look_at: [0, 0, 0], vertical_fov_deg: 40}
materials: {lamp: {emission: [3.0e38, 3.0e38, 3.0e38], albedo: [0.9, 0.9, 0.9]}}
objects: [{name: room, box: {min: [-3, -3, -3], max: [3, 3, 3], facing: in}, material: lamp}]
)");
  const std::string suite = write_text("a.yaml", R"(schema: 1
suite: bright
viewing: {ppd: 60}
scenes: [{id: bright, file: bright.yaml, size: [8, 8]}]
methods: [{id: pt, renderer: path}, {id: nothing, renderer: blank}]
budgets: [{samples: 8}]
)");
  const auto json = discern_json({"run", suite}, "run", 3);
  EXPECT_EQ(json["status"], "failed");
  EXPECT_EQ(json["cells"], 2);
  EXPECT_EQ(json["failed"], 1);
  EXPECT_TRUE(std::filesystem::exists(json["report"].get<std::string>()));
}

TEST_F(RunVerb, ASecondRunSaysThatNothingWasLeftToDo) {
  const auto first = discern_json(ad_hoc(), "run");
  EXPECT_EQ(first["new_repetitions"], 2);
  const auto second = discern(ad_hoc());
  EXPECT_EQ(second.exit.code, 0);
  EXPECT_NE(second.stderr_text.find("every repetition was finished before"), std::string::npos)
      << second.stderr_text;
}

TEST_F(RunVerb, AFilterThatMatchesNothingMeasuresNothing) {
  const auto json = discern_json(ad_hoc({"--filter", "zzz"}), "run", 4);
  EXPECT_EQ(json["status"], "nothing_measured");
  const auto result = discern(ad_hoc({"--filter", "zzz"}));
  EXPECT_EQ(result.exit.code, 4);
  EXPECT_EQ(result.stderr_text,
            "discern: note: nothing to measure: no cell matches --filter \"zzz\"\n");
  const auto last = discern({"report", "last"});
  EXPECT_EQ(last.exit.code, 2) << "a run folder was made for nothing";
}

TEST_F(RunVerb, ASequenceIsRunScoredAndReportedFrameByFrame) {
  write_text("moving.yaml",
             "schema: 1\nscene: moving\ncamera: {position: [0, 1, -3], look_at: [0, 1, 1], "
             "vertical_fov_deg: 40}\nmaterials: {white: {albedo: 0.5}}\nobjects:\n"
             "  - {name: block, box: {min: [0, 0, 0], max: [1, 1, 1]}, material: white,\n"
             "     animation: {keys: [{frame: 0, translate: [0, 0, 0]}, {frame: 3, translate: [1, "
             "0, 0]}]}}\nlights: [{name: key, type: point, position: [0, 2, -1], intensity: 3}]\n");
  const std::string suite = write_text(
      "a.yaml",
      "schema: 1\nsuite: frames\nviewing: {ppd: 60}\nscenes: [{id: moving, file: moving.yaml, "
      "size: [12, 8], frames: [0, 3], reference: {samples: 16}}]\n"
      "methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 2}]\n"
      "measure: {new_view: true}\nmetrics: [mse, flicker]\n");
  const auto json = discern_json({"run", suite}, "run");
  EXPECT_EQ(json["cells"], 1);
  EXPECT_EQ(json["finished_repetitions"], 1);
  const std::filesystem::path run = json["run"].get<std::string>();
  EXPECT_EQ(schema_problems("cell", read(run / "cells.jsonl")), "");
  EXPECT_EQ(schema_problems("metric", read(run / "metrics.jsonl")), "");
  const std::string report = read(json["report"].get<std::string>());
  EXPECT_NE(report.find("Time per frame"), std::string::npos);
  EXPECT_NE(report.find("new view"), std::string::npos);
  EXPECT_NE(report.find("aria-label=\"flicker (own = full) per frame\""), std::string::npos);
  // Three frames of four have a score, against own and full.
  const auto again =
      discern_json({"eval", run.string(), "--metric", "flicker,tvi_scale=2"}, "eval");
  EXPECT_EQ(again["scores"], 6);
}

TEST_F(RunVerb, ASequenceMetricWithoutASequenceIsRefused) {
  expect_refused(ad_hoc({"--metric", "flicker"}),
                 "--metric: metric \"flicker\" scores sequences, and no scene here has 2 frames; "
                 "accepted: a scene with `frames: [first, last]`, or image metrics only");
  const auto run = discern_json(ad_hoc(), "run");
  expect_refused({"eval", run["run"].get<std::string>(), "--metric", "flicker"},
                 "--metric: metric \"flicker\" scores sequences, and no scene here has 2 frames; "
                 "accepted: a scene with `frames: [first, last]`, or image metrics only");
}

/// A build that replaces the program does not end a night: workers are the program that started it.
/// A limit of file sizes stands in for a full disk: small pictures fit, the large one does not.
TEST_F(RunVerb, APictureThatDoesNotFitOnTheDiskEndsTheRunWhichThenGoesOn) {
  const std::string suite =
      write_text("full.yaml",
                 "schema: 1\nsuite: full\nviewing: {ppd: 60}\n"
                 "scenes: [{id: small, file: cornell-box, size: [8, 8]},\n"
                 "         {id: large, file: cornell-box, size: [256, 256]}]\n"
                 "methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 1}]\n"
                 "measure: {order: blocks}\nmetrics: []\n");
  constexpr int kLimit = 128;  // blocks of 512 bytes, as dash counts them
  const auto result = base::run_command(
      {"/bin/sh", "-c",
       fmt::format("ulimit -f {}; exec {} run {}", kLimit, tests::kProgram, suite)},
      std::chrono::minutes(2), environment());
  EXPECT_EQ(result.exit.code, 2) << result.stdout_text << result.stderr_text;
  EXPECT_NE(result.stderr_text.find("images/large.pt"), std::string::npos) << result.stderr_text;
  EXPECT_NE(result.stderr_text.find("File too large"), std::string::npos) << result.stderr_text;
  const auto folder = results::newest_run(path("results"), "full");
  EXPECT_EQ(results::load_run(folder).cells.size(), 1U);
  const auto json = discern_json({"run", suite}, "run");
  EXPECT_EQ(json["run"], folder.string());
  EXPECT_EQ(json["new_repetitions"], 1);
}

TEST_F(RunVerb, GoesOnWhenTheProgramIsReplaced) {
  const std::string suite =
      write_text("long.yaml",
                 "schema: 1\nsuite: long\nviewing: {ppd: 60}\n"
                 "scenes: [{id: box, file: cornell-box, size: [8, 8]}]\n"
                 "methods: [{id: a, renderer: blank, parameters: {sleep_s: 0.5}},\n"
                 "          {id: b, renderer: blank}, {id: c, renderer: blank, preset: paper}]\n"
                 "measure: {warmup: 0, order: blocks}\nmetrics: []\n");
  const std::string copy = path("copy-of-discern");
  std::filesystem::copy_file(kProgram, copy);
  base::ChildProcess::Options options;
  options.arguments = {copy, "run", suite};
  options.stdout_file = path("stdout.log");
  options.stderr_file = path("stderr.log");
  options.environment = environment();
  const std::string build = std::filesystem::path(kProgram).parent_path();
  options.environment.emplace_back("DISCERN_MODULE_DIR", build);
  base::ChildProcess harness(options);
  const auto folder = [&] { return results::newest_run(path("results"), "long"); };
  for (int i = 0; i < 1000 && (folder().empty() || !std::filesystem::exists(folder() / "run.json"));
       ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::filesystem::remove(copy);
  write_text("copy-of-discern", "another program");
  EXPECT_EQ(harness.wait().code, 0);
  EXPECT_EQ(results::load_run(folder()).cells.size(), 3U);
}

}  // namespace
}  // namespace tests
