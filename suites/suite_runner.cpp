#include "suites/suite_runner.h"

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "suites/run_choice.h"
#include "suites/run_session.h"

namespace suites {

namespace {

/// With several jobs each renderer has the cores of its job.
RunOptions with_threads_of_job(RunOptions options) {
  const int cores = base::core_count();
  if (options.jobs < 1 || options.jobs > cores) {
    throw base::InputError(
        fmt::format("--jobs {}; accepted: 1 to {}, a core for each", options.jobs, cores));
  }
  if (options.jobs == 1) return options;
  const int cores_of_job = cores / options.jobs;
  if (options.threads > cores_of_job) {
    throw base::InputError(fmt::format("--threads {} with --jobs {}; accepted: 1 to {} of {} cores",
                                       options.threads, options.jobs, cores_of_job, cores));
  }
  if (options.threads == 0) options.threads = cores_of_job;
  return options;
}

}  // namespace

RunOutcome run_suite(const Suite& suite, const RunOptions& asked,
                     const std::function<void(const Progress&)>& report) {
  const RunOptions options = with_threads_of_job(asked);
  const std::filesystem::path folder =
      choose_run_folder({suite.name, resolved_yaml(suite)}, options);
  return RunSession(suite, options, folder, report).run();
}

std::size_t evaluate_run(const Suite& suite, const std::filesystem::path& run_folder,
                         const RunOptions& options,
                         const std::function<void(const Progress&)>& report) {
  return RunSession(suite, options, run_folder, report).evaluate();
}

renderers::Devices devices_of(const RunOptions& options) {
  return {options.threads, options.platform, nullptr};
}

int exit_code_of(const RunOutcome& outcome) {
  if (outcome.was_interrupted) return 130;
  if (outcome.cells == 0 || outcome.skipped_cells == outcome.cells) return 4;
  if (outcome.failed_cells > 0 || outcome.failed_references > 0 || outcome.failed_scores > 0)
    return 3;
  return 0;
}

}  // namespace suites
