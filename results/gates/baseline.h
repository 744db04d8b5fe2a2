#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "results/result_store.h"

/// The run that later runs are compared with: accepted by a person, with a reason.
///
/// `<results>/baselines/<suite>/<machine>.json`, of a profile `<machine>.<profile>.json`. It holds
/// the records themselves, so that it stays when the run's folder is gone, and can be kept under
/// version control. Keys: schema suite profile machine info (run.json) cells metrics (lines of
/// cells.jsonl and metrics.jsonl) accepted (a list: utc author reason run rows, each with scene
/// method budget old_hash new_hash).
namespace results::gates {

/// Where the baseline of a run is or would be.
std::filesystem::path baseline_file(const std::filesystem::path& results_root, const Run& run);

/// @return nothing if no run was accepted yet
/// @throws base::InputError if the file is no baseline
std::optional<Run> load_baseline(const std::filesystem::path& file);

struct Acceptance {
  std::string author;
  std::string reason;
  std::function<bool(const CellRecord&)> is_chosen;  ///< of what is taken; null: all
};

struct AcceptedRow {
  std::string scene;
  std::string method;
  std::string budget;
  std::string old_hash;  ///< of all pixels of the row; "" if the baseline lacked it
  std::string new_hash;
};

struct AcceptOutcome {
  std::filesystem::path file;
  std::vector<AcceptedRow> rows;
  std::vector<std::string> left_out;  ///< rows without a result: "box pt 64spp: crash 1"
};

/// Takes rows of a run into its baseline, those that match and have a result; others of the
/// baseline stay. Written under another name and renamed.
/// @throws base::InputError if no row is left
AcceptOutcome accept(const std::filesystem::path& results_root, const Run& run,
                     const Acceptance& acceptance);

}  // namespace results::gates
