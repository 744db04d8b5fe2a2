#include "suites/job_cores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>

#include "perception/base/child_process.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using suites::cores_of_jobs;
using tests::Runs;

TEST(JobCores, AreDealtInEvenPartsToEveryJob) {
  for (int count = 1; count <= 17; ++count) {
    std::vector<int> cores(static_cast<std::size_t>(count));
    std::iota(cores.begin(), cores.end(), 3);
    for (int jobs = 1; jobs <= count; ++jobs) {
      std::vector<int> joined;
      std::size_t least = cores.size();
      std::size_t most = 0;
      for (const std::vector<int>& part : cores_of_jobs(cores, jobs)) {
        least = std::min(least, part.size());
        most = std::max(most, part.size());
        joined.insert(joined.end(), part.begin(), part.end());
      }
      EXPECT_EQ(joined, cores) << "contiguous, none left out, none twice";
      EXPECT_GE(least, 1U);
      EXPECT_LE(most - least, 1U);
    }
  }
}

/// A process that a job starts sees the job's cores and no others.
TEST(JobCores, HoldForProcessesThatAJobStarts) {
  const std::vector<int> cores = suites::available_cores();
  const std::vector<std::vector<int>> parts = cores_of_jobs(cores, cores.size() > 1 ? 2 : 1);
  std::vector<std::string> seen(parts.size());
  suites::run_jobs(
      parts,
      [&](int job) {
        const auto result = base::run_command(
            {"/bin/sh", "-c", "sed -n 's/^Cpus_allowed_list:[[:space:]]*//p' /proc/self/status"},
            std::chrono::seconds(20));
        seen[static_cast<std::size_t>(job)] = result.stdout_text;
      },
      [] {});
  EXPECT_EQ(suites::available_cores(), cores) << "the calling thread stays as it was";
  std::set<std::string> different(seen.begin(), seen.end());
  EXPECT_EQ(different.size(), parts.size());
  for (std::size_t job = 0; job < parts.size(); ++job) {
    if (parts[job].size() == 1) {
      EXPECT_EQ(seen[job], std::to_string(parts[job].front()) + "\n");
    }
  }
}

TEST(JobCores, PassOnWhatAJobThrew) {
  bool was_stopped = false;
  const auto work = [](int) { throw std::runtime_error("of the job"); };
  EXPECT_THROW(suites::run_jobs({suites::available_cores()}, work, [&] { was_stopped = true; }),
               std::runtime_error);
  EXPECT_TRUE(was_stopped);
}

class RunsInJobs : public Runs {
 protected:
  static constexpr const char* kFourMethods =
      "methods: [{id: a, renderer: blank, parameters: {sleep_s: 0.05}},\n"
      "          {id: b, renderer: blank, parameters: {sleep_s: 0.05}},\n"
      "          {id: c, renderer: blank, parameters: {behaviour: crash}},\n"
      "          {id: pt, renderer: path, budgets: [{samples: 2}]}]\n"
      "measure: {seeds: 2, repetitions: 3}\nmetrics: [relmse]\n";
  void SetUp() override {
    if (suites::available_cores().size() < 2) GTEST_SKIP() << "needs two cores";
  }
};

TEST_F(RunsInJobs, MeasureWhatOneJobMeasures) {
  suites::RunOptions two = options();
  two.jobs = 2;
  const suites::Suite suite = this->suite(kFourMethods);
  const suites::RunOutcome outcome = tests::run(suite, two);
  EXPECT_EQ(outcome.cells, 5U);
  EXPECT_EQ(outcome.failed_cells, 1U);
  EXPECT_EQ(state_of(outcome), "complete");
  std::map<std::string, int> repetitions;
  for (const results::CellRecord& record : records_of(outcome)) {
    EXPECT_EQ(record.jobs, 2);
    EXPECT_FALSE(record.canary_s.has_value());
    if (record.method == "a") {
      EXPECT_EQ(record.render.threads, static_cast<int>(suites::available_cores().size()) / 2);
    }
    ++repetitions[record.method];
  }
  EXPECT_EQ(repetitions, (std::map<std::string, int>{{"a", 3}, {"b", 3}, {"c", 3}, {"pt", 6}}));

  // Pictures and scores are those of one job; the runs are not each other's continuation.
  const suites::RunOutcome alone = tests::run(suite, options());
  EXPECT_NE(alone.run_folder, outcome.run_folder);
  const results::Run in_jobs = results::load_run(outcome.run_folder);
  const results::Run one_by_one = results::load_run(alone.run_folder);
  ASSERT_EQ(in_jobs.metrics.size(), one_by_one.metrics.size());
  for (std::size_t i = 0; i < in_jobs.metrics.size(); ++i) {
    EXPECT_EQ(in_jobs.metrics[i].value, one_by_one.metrics[i].value);
  }
  // The same command goes on, here with nothing left to do.
  const suites::RunOutcome again = tests::run(suite, two);
  EXPECT_EQ(again.run_folder, outcome.run_folder);
  EXPECT_EQ(again.new_repetitions, 0U);
}

TEST_F(RunsInJobs, RefuseMoreThanThereAreCores) {
  suites::RunOptions many = options();
  const auto cores = static_cast<int>(suites::available_cores().size());
  const suites::Suite suite = this->suite(kFourMethods);
  many.jobs = cores + 1;
  const std::string all = std::to_string(cores);
  EXPECT_EQ(
      tests::input_error_of([&] { tests::run(suite, many); }),
      "--jobs " + std::to_string(cores + 1) + "; accepted: 1 to " + all + ", a core for each");
  many.jobs = cores;
  many.threads = 2;
  EXPECT_EQ(tests::input_error_of([&] { tests::run(suite, many); }),
            "--threads 2 with --jobs " + all + "; accepted: 1 to 1 of " + all + " cores");
}

}  // namespace
