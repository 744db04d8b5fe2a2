// What the harness takes with very many cells: time and greatest memory, each part in a process of
// its own.
//
//   benchmark_harness_scale [load | history | plan | merge]...     all of them if none is named
//
// load:     a run of 10,000 cells, 30,000 repetitions and 50,000 scores, read and summarised
// history:  1,000,000 numbers of 1,000 runs: taken into the index, then asked for trends and steps
// plan:     10^6 cells planned
// merge:    two runs of 500,000 cells each made into one

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/base/document.h"
#include "results/history/history_index.h"
#include "results/history/history_output.h"
#include "results/result_store.h"
#include "results/run_summary.h"
#include "suites/run_merge.h"
#include "suites/run_plan.h"
#include "suites/suite_file.h"
#include "suites/suite_scenes.h"
#include "tests/results/synthetic_run.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Time {
  double wall_s = 0.0;
  double cpu_s = 0.0;  ///< of all threads; a busy machine does not lengthen it much
};

Time seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  work();
  const double cpu_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), cpu_s};
}

void print(const std::string& what, Time time) {
  fmt::print("{:<44} {:8.3f} s, {:8.3f} s of processor time   peak {:6.0f} MiB\n", what,
             time.wall_s, time.cpu_s, static_cast<double>(base::peak_resident_bytes()) / (1 << 20));
  std::fflush(stdout);
}

std::string cell_name(int cell) { return fmt::format("box.m{}.64spp.s1-{:08x}", cell, cell); }

/// A run on disk: cells of as many methods, one seed.
struct RunSize {
  int first_cell = 0;
  int cells = 0;
  int repetitions = 1;
  std::vector<std::string> metrics;
};

void write_run(const fs::path& folder, const RunSize& size, double total_s,
               const std::string& started_utc) {
  fs::create_directories(folder);
  std::ofstream cells(folder / "cells.jsonl");
  std::ofstream scores(folder / "metrics.jsonl");
  ordered_json planned = ordered_json::array();
  for (int i = size.first_cell; i < size.first_cell + size.cells; ++i) {
    results::CellRecord record = test_results::timed_cell("box", fmt::format("m{}", i), 1, total_s);
    record.cell = cell_name(i);
    record.budget = "64spp";
    record.machine = "desk";
    planned.push_back({{"cell", record.cell},
                       {"scene", "box"},
                       {"method", record.method},
                       {"budget", "64spp"},
                       {"seed", 1}});
    for (record.repetition = 0; record.repetition < size.repetitions; ++record.repetition) {
      cells << to_json(record).dump() << '\n';
    }
    for (const std::string& metric : size.metrics) {
      results::MetricRecord score = test_results::full_metric_record();
      score.cell = record.cell;
      score.metric = metric;
      score.against = "full";
      score.value = 0.1;
      scores << to_json(score).dump() << '\n';
    }
  }
  const ordered_json info{
      {"schema", 1},
      {"run", folder.filename().string()},
      {"suite", "scale"},
      {"profile", ""},
      {"state", "complete"},
      {"environment", {{"started_utc", started_utc}, {"commit", "c"}, {"commit_dirty", false}}},
      {"identity", {{"machine", "desk"}}},
      {"metrics", size.metrics},
      {"planned_cells", planned},
      {"references", ordered_json::array()}};
  std::ofstream(folder / "run.json") << info.dump();
}

void time_load(const fs::path& folder) {
  write_run(folder, {0, 10000, 3, {"flip", "relmse", "ssim", "psnr", "visible-difference"}}, 1.0,
            "2026-01-01T00:00:00Z");
  results::Run run;
  print("load: 80,000 lines read", seconds_of([&] { run = results::load_run(folder); }));
  std::size_t rows = 0;
  print("load: 10,000 rows summarised",
        seconds_of([&] { rows = results::summarize(run).rows.size(); }));
  if (rows != 10000) fmt::print("unexpected: {} rows\n", rows);
}

void time_history(const fs::path& root) {
  constexpr int kRuns = 1000;
  for (int i = 0; i < kRuns; ++i) {
    const std::string utc =
        fmt::format("2026-{:02}-{:02}T{:02}:00:00Z", 1 + i / 240, 1 + i % 240 / 10, i % 10);
    write_run(root / "runs/scale" / fmt::format("run-{:04}", i), {0, 250, 1, {"flip"}},
              i < kRuns / 2 ? 1.0 : 1.2, utc);
  }
  using namespace results::history;
  HistoryIndex index(root);
  print("history: 1,000 runs taken in", seconds_of([&] { index.update(true); }));
  print("history: nothing new", seconds_of([&] { index.update(false); }));
  std::vector<Series> series;
  print("history: 250 series of 1,000 runs", seconds_of([&] {
          series = index.series({"scale", "total_s", "", "desk", 0});
        }));
  std::size_t steps = 0;
  print("history: their steps", seconds_of([&] {
          for (const Trend& trend : trends_of(series, 0.05)) steps += trend.steps.size();
        }));
  print("history: last 30 runs", seconds_of([&] {
          series = index.series({"scale", "flip@full", "", "desk", 30});
        }));
  fmt::print("{} steps in 250 series\n", steps);
}

void time_plan(const fs::path& folder) {
  std::string values;
  for (int i = 1; i <= 1000; ++i) values += fmt::format("{}{}", i > 1 ? ", " : "", i);
  std::string scenes;
  for (int i = 0; i < 10; ++i) {
    scenes += fmt::format("{}{{id: box{}, file: cornell-box, size: [8, 8]}}", i > 0 ? ", " : "", i);
  }
  std::ofstream(folder / "scale.yaml")
      << "schema: 1\nsuite: scale\nviewing: {ppd: 60}\nscenes: [" << scenes
      << "]\nmethods: [{id: pt, renderer: path, budgets: [{samples: 1}], matrix: {max_depth: ["
      << values << "]}, measure: {seeds: 100}}]\nmetrics: []\n";
  suites::Suite suite;
  std::vector<suites::SceneStates> scenes_of_suite;
  suites::RunPlan plan;
  print("plan: suite of 1,000 methods read", seconds_of([&] {
          suite = suites::read_suite(folder / "scale.yaml", "");
          scenes_of_suite = suites::load_scenes(suite);
        }));
  print("plan: cells planned", seconds_of([&] { plan = make_plan(suite, scenes_of_suite); }));
  fmt::print("{} cells\n", plan.cells.size());
}

void time_merge(const fs::path& root) {
  for (int part = 0; part < 2; ++part) {
    write_run(root / "runs/scale" / fmt::format("part-{}", part), {500000 * part, 500000, 1, {}},
              1.0, "2026-01-01T00:00:00Z");
  }
}

void time_merge_itself(const fs::path& root) {
  const fs::path runs = root / "runs/scale";
  print("merge: two runs of 500,000 cells", seconds_of([&] {
          suites::merge_runs(root, {runs / "part-0", runs / "part-1"});
        }));
}

/// In a process of its own, so that its greatest memory is its own.
void in_own_process(const std::function<void()>& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    work();
    std::fflush(stdout);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) fmt::print("ended with status {}\n", status);
}

}  // namespace

int main(int count, char** words) {
  const std::map<std::string, std::vector<void (*)(const fs::path&)>> parts{
      {"load", {time_load}},
      {"history", {time_history}},
      {"plan", {time_plan}},
      {"merge", {time_merge, time_merge_itself}}};
  std::vector<std::string> chosen(words + 1, words + count);
  if (chosen.empty()) chosen = {"load", "history", "plan", "merge"};
  for (const std::string& name : chosen) {
    if (!parts.contains(name)) {
      fmt::print(stderr, "unknown part \"{}\"; known: load, history, plan, merge\n", name);
      return 2;
    }
    const tests::TemporaryFolder folder;
    for (auto* const work : parts.at(name)) in_own_process([&] { work(folder.path()); });
  }
  return 0;
}
