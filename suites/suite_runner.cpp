#include "suites/suite_runner.h"

#include "suites/run_choice.h"
#include "suites/run_session.h"

namespace suites {

RunOutcome run_suite(const Suite& suite, const RunOptions& options,
                     const std::function<void(const Progress&)>& report) {
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
