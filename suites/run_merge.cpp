#include "suites/run_merge.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/hash.h"
#include "perception/base/units.h"
#include "results/result_store.h"
#include "results/run_files.h"
#include "suites/suite_file.h"

namespace suites {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// A run without its records, which are copied as they are.
struct Part {
  fs::path folder;
  Json info;
  std::string resolved_suite;
};

Part read_part(const fs::path& folder) {
  if (const std::string kind = results::run_kind(folder); kind != "images") {
    throw base::InputError(
        fmt::format("{}: a run of kind {}; accepted here: a run of images", folder.string(), kind));
  }
  return {folder, results::read_run_json(folder),
          results::text_or_empty(folder / "suite.resolved.yaml")};
}

/// What all parts must share: where it stands in run.json, and what it is called.
void require_same(const Part& first, const Part& other) {
  const auto fail = [&](const std::string& what, const std::string& here,
                        const std::string& there) {
    throw base::InputError({other.folder.string()},
                           fmt::format("{} is {}, of {} it is {}; accepted: parts of one suite, "
                                       "measured by one build on one machine",
                                       what, there, first.folder.string(), here));
  };
  for (const char* key : {"suite", "profile"}) {
    const std::string here = first.info.value(key, "");
    const std::string there = other.info.value(key, "");
    if (here != there) fail(key, '"' + here + '"', '"' + there + '"');
  }
  const Json one = first.info.value("identity", Json::object());
  const Json two = other.info.value("identity", Json::object());
  std::set<std::string> keys;
  for (const auto& [key, value] : one.items()) keys.insert(key);
  for (const auto& [key, value] : two.items()) keys.insert(key);
  for (const std::string& key : keys) {
    const Json here = one.value(key, Json());
    const Json there = two.value(key, Json());
    if (there != here) fail(key, here.dump(), there.dump());
  }
  if (measured_part(first.resolved_suite) != measured_part(other.resolved_suite)) {
    throw base::InputError({other.folder.string()},
                           "the suite measured something else then: compare suite.resolved.yaml");
  }
}

void require_complete(const Part& run) {
  const std::string state = run.info.value("state", "");
  if (state == "complete") return;
  throw base::InputError({run.folder.string()},
                         fmt::format("the run is {}; run its command again first",
                                     state.empty() ? "of an older version" : state));
}

void require_disjoint(const std::vector<Part>& runs) {
  std::unordered_map<std::string, const Part*> owner;
  for (const Part& run : runs) {
    results::read_cell_names(run.folder, [&](const std::string& cell) {
      const auto [entry, is_new] = owner.emplace(cell, &run);
      if (is_new || entry->second == &run) return;
      throw base::InputError({run.folder.string()},
                             fmt::format("cell {} is in {}, too; accepted: parts that share none",
                                         cell, entry->second->folder.string()));
    });
  }
}

/// Scores against two states of one reference do not belong in one table.
void require_same_references(const std::vector<Part>& runs) {
  std::map<std::string, std::string> pixels;
  for (const Part& run : runs) {
    for (const Json& entry : run.info.value("references", Json::array())) {
      const std::string hash = entry.value("hash", "");
      const std::string pixel_hash = entry.value("pixel_hash", "");
      if (hash.empty()) continue;
      if (pixels.emplace(hash, pixel_hash).first->second == pixel_hash) continue;
      throw base::InputError({run.folder.string()},
                             fmt::format("reference {} had other pixels then; `discern eval` "
                                         "scores a run again",
                                         hash));
    }
  }
}

/// A planned cell is known by its name, all else by what it says. Names of a million cells would
/// take more memory than what they are the names of.
base::Hash identity_of(const Json& entry) {
  const auto cell = entry.find("cell");
  const bool is_cell = cell != entry.end() && entry.contains("seed");
  return base::hash_of(is_cell ? cell->get_ref<const std::string&>() : entry.dump());
}
struct LowBits {
  std::size_t operator()(const base::Hash& hash) const { return hash.low; }
};

/// Lists of run.json that each part has its own share of.
void append_lists(Json from, Json& to) {
  for (const char* key : {"planned_cells", "references", "score_failures"}) {
    if (!from.contains(key) || !from.at(key).is_array()) continue;
    if (!to.contains(key)) to[key] = Json::array();
    std::unordered_set<base::Hash, LowBits> known;
    known.reserve(to[key].size() + from.at(key).size());
    for (const Json& entry : to[key]) known.insert(identity_of(entry));
    for (Json& entry : from.at(key)) {
      if (known.insert(identity_of(entry)).second) to[key].push_back(std::move(entry));
    }
  }
}

/// Takes what the parts say; it can be much where there are many cells.
Json merged_info(std::vector<Part> runs, const fs::path& folder) {
  Json info = std::move(runs.front().info);
  info["run"] = folder.filename().string();
  info["filter"] = "";
  info["merged_from"] = Json::array();
  for (const Part& run : runs) info["merged_from"].push_back(run.folder.filename().string());
  for (std::size_t i = 1; i < runs.size(); ++i) append_lists(std::move(runs[i].info), info);
  info["updated_utc"] = base::utc_now();
  return info;
}

void copy_files(const fs::path& from, const fs::path& to) {
  for (const char* name : {"images", "maps"}) {
    if (!fs::exists(from / name)) continue;
    fs::copy(from / name, to / name,
             fs::copy_options::recursive | fs::copy_options::copy_symlinks |
                 fs::copy_options::skip_existing);
  }
}

void write_merged(std::vector<Part> runs, const fs::path& path) {
  auto folder = results::RunFolder::open_for_writing(path);
  folder.write_resolved_suite(runs.front().resolved_suite);
  for (const Part& run : runs) results::require_no_links(run.folder);
  for (const Part& run : runs) {
    copy_files(run.folder, path);
    for (const char* name :
         {"cells.jsonl", "metrics.jsonl", "convergence.jsonl", "searches.jsonl"}) {
      results::append_file(run.folder / name, path / name);
    }
  }
  // Last: until then it is no run that `last` could name.
  folder.write_run_json(merged_info(std::move(runs), path));
}

}  // namespace

fs::path merge_runs(const fs::path& results_root, const std::vector<fs::path>& parts) {
  if (parts.size() < 2) {
    throw base::InputError(fmt::format("{} run named; accepted: two or more", parts.size()));
  }
  std::vector<Part> runs;
  for (const fs::path& part : parts) runs.push_back(read_part(part));
  for (const Part& run : runs) {
    require_same(runs.front(), run);
    require_complete(run);
  }
  require_disjoint(runs);
  require_same_references(runs);
  const fs::path path = results::new_run_folder(
      results_root, results::path_name(runs.front().info, "suite", runs.front().folder));
  try {
    write_merged(std::move(runs), path);
  } catch (...) {
    std::error_code error;  // what is half there is no run
    fs::remove_all(path, error);
    throw;
  }
  return path;
}

}  // namespace suites
