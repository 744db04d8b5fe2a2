#include "suites/cost_records.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "results/json_fields.h"
#include "results/result_store.h"
#include "results/run_files.h"

namespace suites {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Sorted by name; runs by time, because that is how they are named.
std::vector<fs::path> subfolders(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory(error)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// A run of images that the machine made.
bool is_run_of(const fs::path& folder, const std::string& machine) {
  if (!fs::exists(folder / "run.json")) return false;
  const Json info = results::read_run_json(folder);
  if (info.contains("kind") && info.at("kind") != "images") return false;
  const auto identity = info.find("identity");
  return identity != info.end() && identity->is_object() && identity->contains("machine") &&
         identity->at("machine") == machine;
}

void add_run(const fs::path& folder, StoredCosts& costs) {
  for (results::CellRecord& cell : results::load_run(folder).cells) {
    costs.records.repetitions.push_back(std::move(cell.render));
  }
  ++costs.runs;
}

void add_newest_run(const fs::path& suite_folder, const std::string& machine, StoredCosts& costs) {
  const std::vector<fs::path> runs = subfolders(suite_folder);
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    // An estimate does without a damaged run of some other suite; the count is told.
    try {
      if (!is_run_of(*run, machine)) continue;
      add_run(*run, costs);
      return;
    } catch (const base::InputError&) {
      ++costs.unreadable;
    }
  }
}

/// Nothing for a reference of another machine, or one that is still empty.
std::optional<MeasuredReference> read_reference(const fs::path& file, const std::string& machine) {
  const Json json = Json::parse(base::read_text_file(file), nullptr, false);
  const results::JsonFields fields(json, "reference.json");
  const Json& size = fields.list("size_px");
  const double pixels = size.size() == 2 && size[0].is_number() && size[1].is_number()
                            ? size[0].get<double>() * size[1].get<double>()
                            : 0.0;
  const double work = pixels * static_cast<double>(fields.integer("samples"));
  const double seconds = fields.number("seconds");
  if (fields.optional_text("machine") != machine || !(work > 0.0) || !(seconds > 0.0)) {
    return std::nullopt;
  }
  return MeasuredReference{fields.text("scene_hash"), fields.text("renderer"),
                           fields.text("transport"), work, seconds};
}

}  // namespace

StoredCosts load_costs(const fs::path& results_root, const std::string& machine) {
  StoredCosts costs;
  for (const fs::path& suite_folder : subfolders(results_root / "runs")) {
    add_newest_run(suite_folder, machine, costs);
  }
  for (const fs::path& folder : subfolders(results_root / "references")) {
    if (!fs::exists(folder / "reference.json")) continue;
    try {
      const auto reference = read_reference(folder / "reference.json", machine);
      if (reference) costs.records.references.push_back(*reference);
    } catch (const base::InputError&) {
      ++costs.unreadable;
    }
  }
  return costs;
}

}  // namespace suites
