#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "suites/interruption.h"
#include "suites/run_plan.h"
#include "suites/worker.h"

namespace suites {

struct RunOptions {
  std::filesystem::path results_root;
  /// Empty: the newest run of this suite with the same resolved file, build and machine goes on, or
  /// a new one is made.
  std::filesystem::path run_folder;
  bool force = false;  ///< a new run in any case
  std::string filter;
  int threads = 0;  ///< of a renderer; 0: one per core that a job has
  /// (Scene, method) pairs that are measured at once, each on cores of its own; at most one per
  /// core. Times of several jobs are those of a busy machine and are compared with no others.
  int jobs = 1;
  std::string platform = "auto";
  std::string command;  ///< the command line, for run.json
  /// Started as `<executable> worker`; empty: this program.
  std::filesystem::path worker_executable;
};

renderers::Devices devices_of(const RunOptions& options);

/// What is going on, for the progress display.
struct Progress {
  std::string activity;  ///< "reference horse full", "horse pt8 64spp s1"
  std::size_t done = 0;
  std::size_t total = 0;
  double elapsed_s = 0.0;
  double remaining_s = 0.0;  ///< negative: not known yet
};

struct RunOutcome {
  std::filesystem::path run_folder;
  std::size_t cells = 0;
  std::size_t finished_repetitions = 0;  ///< those of earlier sessions of a resumed run included
  std::size_t new_repetitions = 0;       ///< of this session; 0: there was nothing to do
  std::size_t failed_scores = 0;         ///< cells whose image could not be scored; see run.json
  std::size_t failed_references = 0;     ///< their methods have no scores; reasons are in run.json
  std::size_t failed_cells = 0;          ///< crash, timeout, out_of_memory, non_finite, diverged
  std::size_t skipped_cells = 0;         ///< unsupported, skipped
  bool was_interrupted = false;
};

/// Runs a suite from plan to metrics: references, workers, records, scores. Re-running resumes.
/// @param report  called often, never twice at once
/// @throws base::InputError for jobs or threads that the cores are not enough for
RunOutcome run_suite(const Suite& suite, const RunOptions& options,
                     const std::function<void(const Progress&)>& report);

/// Scores stored images again, no rendering: appends to metrics.jsonl.
/// @return number of scores made
std::size_t evaluate_run(const Suite& suite, const std::filesystem::path& run_folder,
                         const RunOptions& options,
                         const std::function<void(const Progress&)>& report);

/// 130, 2, 4, 3, 1, 5 in this order of precedence (DESIGN section 5).
int exit_code_of(const RunOutcome& outcome);

}  // namespace suites
