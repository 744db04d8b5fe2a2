#include "suites/run_choice.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "results/result_store.h"
#include "suites/run_description.h"
#include "suites/suite_file.h"

namespace suites {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The identity in a run's run.json; null if there is none to read.
Json stored_identity(const fs::path& folder) {
  if (!fs::exists(folder / "run.json")) return {};
  const Json info = Json::parse(base::read_text_file(folder / "run.json"), nullptr, false);
  return info.is_object() && info.contains("identity") ? info.at("identity") : Json();
}

bool has_suite(const fs::path& folder, const std::string& resolved) {
  const fs::path file = folder / "suite.resolved.yaml";
  return fs::exists(file) && measured_part(base::read_text_file(file)) == measured_part(resolved);
}

fs::path checked_folder(const fs::path& folder, const std::string& resolved, const Json& identity) {
  if (!fs::exists(folder / "run.json")) return folder;
  if (!has_suite(folder, resolved)) {
    throw base::InputError(fmt::format(
        "{}: holds a run of another suite or profile (see suite.resolved.yaml there); use another "
        "folder",
        folder.string()));
  }
  const Json stored = stored_identity(folder);
  if (stored != identity) {
    throw base::InputError(
        fmt::format("{}: was made by another build, machine or device: {}; this is {}; use "
                    "another folder",
                    folder.string(), stored.dump(), identity.dump()));
  }
  return folder;
}

}  // namespace

fs::path choose_run_folder(const SuiteIdentity& suite, const RunOptions& options) {
  const std::string& resolved = suite.resolved;
  const Json identity = run_identity(options);
  if (!options.run_folder.empty()) return checked_folder(options.run_folder, resolved, identity);
  if (!options.force) {
    // Names start with the time: the last is the newest.
    std::vector<fs::path> folders;
    std::error_code error;
    const fs::path parent = options.results_root / "runs" / suite.name;
    for (const auto& entry : fs::directory_iterator(parent, error)) {
      if (entry.is_directory(error)) folders.push_back(entry.path());
    }
    std::sort(folders.begin(), folders.end());
    for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) {
      if (has_suite(*folder, resolved) && stored_identity(*folder) == identity) return *folder;
    }
  }
  return results::new_run_folder(options.results_root, suite.name);
}

}  // namespace suites
