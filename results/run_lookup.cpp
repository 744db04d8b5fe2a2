#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/base/errors.h"
#include "results/build_facts.h"
#include "results/result_store.h"
#include "results/run_files.h"

namespace results {

namespace fs = std::filesystem;

namespace {

bool is_checkout(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "CMakeLists.txt", error) &&
         fs::exists(folder / "results/run_record.h", error);
}

std::vector<fs::path> subfolders(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory(error)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// Runs of one suite or of all (""), newest first: their names start with the time.
std::vector<fs::path> runs_newest_first(const fs::path& results_root, const std::string& suite) {
  std::vector<fs::path> runs;
  for (const fs::path& suite_folder : subfolders(results_root / "runs")) {
    if (!suite.empty() && suite_folder.filename() != suite) continue;
    for (fs::path& run : subfolders(suite_folder)) runs.push_back(std::move(run));
  }
  std::stable_sort(runs.begin(), runs.end(), [](const fs::path& a, const fs::path& b) {
    return a.filename() > b.filename();
  });
  return runs;
}

constexpr const char* kStampFormat = "%Y%m%dT%H%M%SZ";
constexpr std::size_t kStampLength = 16;

std::string stamp_of(std::time_t time) {
  std::tm parts{};
  gmtime_r(&time, &parts);
  std::array<char, kStampLength + 1> text{};
  return {text.data(), std::strftime(text.data(), text.size(), kStampFormat, &parts)};
}

/// "20261122T001209Z", a second later than the newest run's if that is not past by the clock, which
/// may have been set back: runs are in the order of their names. When it began by the clock stands
/// in the run.
std::string next_stamp(const fs::path& results_root) {
  const std::string now = stamp_of(std::time(nullptr));
  const std::vector<fs::path> runs = runs_newest_first(results_root, "");
  if (runs.empty()) return now;
  const std::string newest = runs.front().filename().string().substr(0, kStampLength);
  std::tm parts{};
  const char* end = strptime(newest.c_str(), kStampFormat, &parts);
  if (newest < now || end == nullptr || *end != '\0') return now;
  return stamp_of(timegm(&parts) + 1);
}

}  // namespace

fs::path results_root(const std::string& option) {
  if (!option.empty()) return option;
  const char* variable = std::getenv("DISCERN_RESULTS");
  if (variable != nullptr && *variable != '\0') return variable;
  const fs::path beside_build = base::executable_path().parent_path().parent_path();
  for (const fs::path& checkout : {beside_build, fs::path(build_facts::kSourceFolder)}) {
    if (is_checkout(checkout)) return checkout / "results";
  }
  throw base::InputError(
      fmt::format("no folder for results: {} is not a checkout; use --results DIR or set "
                  "DISCERN_RESULTS",
                  beside_build.string()));
}

fs::path new_run_folder(const fs::path& root, const std::string& suite) {
  std::random_device random;
  const std::string stamp = next_stamp(root);
  fs::path folder;
  std::error_code unreadable;  // told by who makes the folder
  do {
    folder = root / "runs" / suite / fmt::format("{}-{:06x}", stamp, random() & 0xFFFFFFU);
  } while (fs::exists(folder, unreadable));
  return folder;
}

fs::path newest_run(const fs::path& root, const std::string& suite) {
  const std::vector<fs::path> runs = runs_newest_first(root, suite);
  return runs.empty() ? fs::path() : runs.front();
}

fs::path newest_run_of_profile(const fs::path& root, const std::string& suite,
                               const std::string& profile) {
  for (const fs::path& run : runs_newest_first(root, suite)) {
    if (read_run_json(run).value("profile", "") == profile) return run;
  }
  return {};
}

fs::path find_run(const fs::path& root, const std::string& name) {
  std::error_code error;
  if (fs::exists(fs::path(name) / "run.json", error)) return name;
  const std::vector<fs::path> runs = runs_newest_first(root, "");
  if (runs.empty()) {
    throw base::InputError(
        fmt::format("no run \"{}\": {} holds no runs yet; make one with "
                    "`discern run SUITE`",
                    name, (root / "runs").string()));
  }
  if (name == "last") return runs.front();
  std::vector<std::string> known{"last"};
  for (const fs::path& run : runs) {
    const std::string suite = run.parent_path().filename().string();
    if (run.filename() == name || suite == name) return run;
    if (std::find(known.begin(), known.end(), suite) == known.end()) known.push_back(suite);
  }
  constexpr std::size_t kNamedRuns = 8;
  for (std::size_t i = 0; i < std::min(kNamedRuns, runs.size()); ++i) {
    known.push_back(runs[i].filename().string());
  }
  throw base::InputError(base::unknown_name("run", name, known));
}

}  // namespace results
