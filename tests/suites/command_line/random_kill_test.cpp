#include <signal.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "results/result_store.h"
#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

constexpr int kKills = 40;
constexpr int kRepetitions = 6;

/// Kills the harness, or one of its workers, at moments that nobody chose.
class RandomKills : public ProgramTest {
 protected:
  RandomKills() {
    suite_ = write_text(
        "suite.yaml",
        fmt::format("schema: 1\nsuite: killed\nviewing: {{ppd: 60}}\n"
                    "scenes: [{{id: spot, file: cornell-box-spot, size: [24, 24], "
                    "reference: {{samples: 256}}}},\n"
                    "         {{id: box, file: cornell-box, size: [24, 24], "
                    "reference: {{samples: 256}}}}]\n"
                    "methods: [{{id: a, renderer: blank, parameters: {{sleep_s: 0.03}}}},\n"
                    "          {{id: b, renderer: blank, parameters: {{sleep_s: 0.02, "
                    "checkpoints: 3, radiance: 1}}}},\n"
                    "          {{id: pt, renderer: path, budgets: [{{samples: 16}}]}}]\n"
                    "measure: {{seeds: 3, repetitions: {{min: {0}, max: {0}}}}}\n"
                    "metrics: [relmse, flip]\n",
                    kRepetitions));
  }

  /// The newest run's folder; empty before there is one.
  fs::path run_folder() const { return results::newest_run(fs::path(path("results")), "killed"); }
  std::string finished_lines() const {
    const fs::path folder = run_folder();
    const fs::path file = folder / "cells.jsonl";
    if (folder.empty() || !fs::exists(file)) return "";
    const std::string text = base::read_text_file(file);
    return text.substr(0, text.rfind('\n') + 1);
  }
  /// A child of the process, if it has one: a worker.
  static pid_t worker_of(pid_t pid) {
    std::ifstream children(fmt::format("/proc/{0}/task/{0}/children", pid));
    pid_t child = -1;
    children >> child;
    return child;
  }
  static bool is_alive(pid_t pid) { return pid > 0 && kill(pid, 0) == 0; }

  /// Starts the suite and kills it after a while. @return its worker at that moment, or -1
  pid_t run_and_kill(double after_s, bool kills_worker_first) {
    base::ChildProcess::Options options;
    options.arguments = {kProgram, "run", suite_};
    options.stdout_file = path("stdout.log");
    options.stderr_file = path("stderr.log");
    options.environment = environment();
    base::ChildProcess harness(options);
    const std::chrono::duration<double> wait(after_s);
    std::this_thread::sleep_for(wait / 2);
    if (kills_worker_first) {
      const pid_t worker = worker_of(harness.pid());
      if (worker > 0 && kill(worker, SIGKILL) == 0) ++killed_workers_;
    }
    std::this_thread::sleep_for(wait / 2);
    const pid_t worker = worker_of(harness.pid());
    kill(harness.pid(), SIGKILL);
    harness.wait();
    return worker;
  }

  std::string suite_;
  int killed_workers_ = 0;
};

TEST_F(RandomKills, LoseAtMostTheRepetitionInFlight) {
  std::mt19937 random(20261128);
  std::uniform_real_distribution<double> seconds(0.02, 1.2);
  std::string earlier;
  int with_progress = 0;
  for (int i = 0; i < kKills; ++i) {
    const pid_t worker = run_and_kill(seconds(random), i % 3 == 1);
    const std::string lines = finished_lines();
    // What was finished stays as it was, byte for byte.
    ASSERT_EQ(lines.substr(0, earlier.size()), earlier) << "kill " << i;
    if (lines.size() > earlier.size()) ++with_progress;
    earlier = lines;
    // No worker outlives its harness.
    for (int wait = 0; is_alive(worker) && wait < 200; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_FALSE(is_alive(worker));
  }
  EXPECT_GT(with_progress, 0);
  EXPECT_GT(killed_workers_, 0);

  const base::CommandResult last = discern({"run", suite_});
  EXPECT_TRUE(last.exit.code == 0 || last.exit.code == 3) << last.stderr_text;
  const results::Run run = results::load_run(run_folder());
  EXPECT_EQ(run.info->at("state"), "complete");
  std::map<std::string, std::set<int>> repetitions;
  std::size_t killed = 0;
  for (const results::CellRecord& record : run.cells) {
    EXPECT_TRUE(repetitions[record.cell].insert(record.repetition).second) << record.cell;
    if (record.render.status == results::Status::crash) {
      ++killed;
      EXPECT_NE(record.render.reason.value_or("").find("signal 9"), std::string::npos);
      continue;
    }
    ASSERT_EQ(record.render.status, results::Status::ok) << record.render.reason.value_or("");
    const perception::Image image = perception::read_image(run.folder / record.render.image);
    EXPECT_EQ(perception::pixel_hash(image), record.render.pixel_hash);
  }
  EXPECT_EQ(last.exit.code == 3, killed > 0);
  // Two scenes of a, b and three seeds of pt; only what was killed is missing, and named.
  EXPECT_EQ(repetitions.size(), 10U);
  for (const auto& [cell, numbers] : repetitions) {
    EXPECT_EQ(numbers.size(), static_cast<std::size_t>(kRepetitions)) << cell;
  }
  for (const auto& entry : fs::recursive_directory_iterator(run.folder)) {
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }
  for (const auto& entry : fs::recursive_directory_iterator(path("results/references"))) {
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }
  // Every image is scored against both truths.
  EXPECT_EQ(run.metrics.size(), 10U * 2U * 2U);
  EXPECT_EQ(discern({"run", suite_}).exit.code, last.exit.code);
}

}  // namespace
}  // namespace tests
