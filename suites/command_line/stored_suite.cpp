#include "suites/command_line/stored_suite.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace suites::command_line {

namespace {

std::filesystem::path run_folder_of(const Suite& suite, const std::string& run,
                                    const std::filesystem::path& root) {
  if (!run.empty()) return results::find_run(root, run);
  const std::filesystem::path folder = results::newest_run(root, suite.name);
  if (!folder.empty()) return folder;
  throw base::InputError(
      fmt::format("there is no run of suite \"{}\" in {}; make one with `discern "
                  "run {}`, or name one with --run",
                  suite.name, (root / "runs").string(), suite.name));
}

}  // namespace

StoredSuite load_stored_suite(const std::string& suite, const std::string& run,
                              const std::string& results_option) {
  const std::filesystem::path file = find_suite(suite);
  StoredSuite stored;
  stored.suite = read_suite(file, "");
  const std::filesystem::path folder =
      run_folder_of(stored.suite, run, results::results_root(results_option));
  stored.run = results::load_run(folder);
  const std::string name = stored.run.info->value("suite", "");
  if (name != stored.suite.name) {
    throw base::InputError(fmt::format("{}: is a run of suite \"{}\"; asked for: \"{}\"",
                                       folder.string(), name, stored.suite.name));
  }
  return stored;
}

}  // namespace suites::command_line
