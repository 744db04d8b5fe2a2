#include "tests/suites/test_suite.h"
#include "tests/places.h"

#include "perception/base/atomic_file.h"

namespace tests {

void write_scene(const std::filesystem::path& folder) {
  base::write_text_file(folder / "walls.yaml", kSceneText);
  base::write_text_file(folder / "moving.yaml", kMovingText);
}

suites::Suite suite_from(const std::filesystem::path& folder, const std::string& text,
                         const std::string& profile) {
  write_scene(folder);
  return suites::parse_suite(base::parse_document(text, "trial.yaml"), folder / "trial.yaml",
                             profile);
}

suites::RunOptions run_options(const std::filesystem::path& folder) {
  suites::RunOptions options;
  options.results_root = folder / "results";
  options.threads = 1;
  options.command = "test";
  options.worker_executable = tests::kSuiteWorker;
  return options;
}

suites::RunOutcome run(const suites::Suite& suite, const suites::RunOptions& options) {
  return suites::run_suite(suite, options, {});
}

}  // namespace tests
