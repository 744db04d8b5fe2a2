#include "results/gates/baseline.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/document.h"
#include "perception/base/errors.h"
#include "perception/base/hash.h"
#include "perception/base/units.h"
#include "results/run_files.h"
#include "results/run_record.h"
#include "results/run_summary.h"
#include "results/tables.h"

namespace results::gates {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

using RowKey = std::tuple<std::string, std::string, std::string>;

RowKey key_of(const CellRecord& record) { return {record.scene, record.method, record.budget}; }

/// Of the pixels of every seed and frame, however often they were repeated.
std::map<RowKey, std::string> row_hashes(const Run& run) {
  std::map<RowKey, std::set<std::string>> pixels;
  for (const CellRecord& record : run.cells) {
    pixels[key_of(record)].insert(
        fmt::format("{} {} {}", record.render.seed, record.render.frame, record.render.pixel_hash));
  }
  std::map<RowKey, std::string> hashes;
  for (const auto& [key, texts] : pixels) {
    base::Hasher hasher;
    for (const std::string& text : texts) hasher.add(text);
    hashes[key] = hasher.finish().hex();
  }
  return hashes;
}

/// Rows that match; those without a result are told.
std::set<RowKey> chosen_rows(const Run& run, const Acceptance& acceptance, AcceptOutcome& outcome) {
  std::set<RowKey> chosen;
  for (const SummaryRow& row : summarize(run).rows) {
    const bool is_chosen = std::ranges::any_of(row.records, [&](std::size_t i) {
      return !acceptance.is_chosen || acceptance.is_chosen(run.cells[i]);
    });
    if (!is_chosen) continue;
    if (row.has_failure() || !row.total_s) {
      outcome.left_out.push_back(
          fmt::format("{} {} {}: {}", row.scene, row.method, row.budget, format_statuses(row)));
      continue;
    }
    chosen.insert({row.scene, row.method, row.budget});
  }
  return chosen;
}

/// Appends what is chosen behind what stays of the baseline.
template <typename Record, typename KeyOf>
std::vector<Record> merged(const std::vector<Record>& old, const std::vector<Record>& now,
                           const std::set<RowKey>& chosen, const KeyOf& key) {
  std::vector<Record> records;
  std::ranges::copy_if(old, std::back_inserter(records),
                       [&](const Record& one) { return !chosen.contains(key(one)); });
  std::ranges::copy_if(now, std::back_inserter(records),
                       [&](const Record& one) { return chosen.contains(key(one)); });
  return records;
}

std::map<std::string, RowKey> rows_of_cells(const Run& run) {
  std::map<std::string, RowKey> rows;
  for (const CellRecord& record : run.cells) rows[record.cell] = key_of(record);
  return rows;
}

template <typename Record>
ordered_json json_list(const std::vector<Record>& records) {
  ordered_json list = ordered_json::array();
  for (const Record& record : records) list.push_back(to_json(record));
  return list;
}

ordered_json entry_json(const Run& run, const Acceptance& acceptance,
                        const AcceptOutcome& outcome) {
  ordered_json rows = ordered_json::array();
  for (const AcceptedRow& row : outcome.rows) {
    rows.push_back({{"scene", row.scene},
                    {"method", row.method},
                    {"budget", row.budget},
                    {"old_hash", row.old_hash},
                    {"new_hash", row.new_hash}});
  }
  return {{"utc", base::utc_now()},
          {"author", acceptance.author},
          {"reason", acceptance.reason},
          {"run", run.folder.filename().string()},
          {"rows", std::move(rows)}};
}

/// Two people who accept at once do so one after the other.
File locked(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) fail_file(path, "open", errno);
  if (::flock(fd, LOCK_EX) != 0) {
    const int error = errno;
    ::close(fd);
    fail_file(path, "lock", error);
  }
  return File(fd);
}

ordered_json read_json(const fs::path& file) {
  const std::string text = text_or_empty(file);
  try {
    ordered_json json = ordered_json::parse(text);
    if (json.is_object() && json.value("schema", 0) == kSchemaVersion && json.contains("info") &&
        json.contains("cells") && json.contains("metrics") && json.contains("accepted")) {
      return json;
    }
  } catch (const nlohmann::json::exception&) {
    // Told below, with what would be accepted.
  }
  throw base::InputError({file.string()},
                         "this is no baseline of schema 1; `discern accept` writes one");
}

}  // namespace

fs::path baseline_file(const fs::path& results_root, const Run& run) {
  const std::string suite = path_name(*run.info, "suite", run.folder);
  const std::string profile = path_name(*run.info, "profile", run.folder);
  ordered_json environment = run.info->value("environment", ordered_json::object());
  if (!run.cells.empty()) environment["machine"] = run.cells.front().machine;
  const std::string machine = path_name(environment, "machine", run.folder);
  const std::string name = profile.empty() ? machine : fmt::format("{}.{}", machine, profile);
  return results_root / "baselines" / suite / (name + ".json");
}

std::optional<Run> load_baseline(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  const ordered_json json = read_json(file);
  Run run;
  run.folder = file;
  run.info = std::make_shared<const ordered_json>(json.at("info"));
  for (const ordered_json& cell : json.at("cells")) {
    run.cells.push_back(cell_record_from_json(cell));
  }
  for (const ordered_json& score : json.at("metrics")) {
    run.metrics.push_back(metric_record_from_json(score));
  }
  return run;
}

AcceptOutcome accept(const fs::path& results_root, const Run& run, const Acceptance& acceptance) {
  const std::string state = run.info->value("state", "complete");
  if (state != "complete") {
    throw base::InputError(
        fmt::format("{}: the run is {}; accepted: one that is complete (run its command again)",
                    run.folder.string(), state));
  }
  AcceptOutcome outcome;
  outcome.file = baseline_file(results_root, run);
  const std::set<RowKey> chosen = chosen_rows(run, acceptance, outcome);
  if (chosen.empty()) {
    throw base::InputError(
        outcome.left_out.empty()
            ? "no row of the run matches; nothing was accepted"
            : fmt::format("no row has a result ({}); nothing was accepted", outcome.left_out[0]));
  }
  fs::create_directories(outcome.file.parent_path());
  const File lock = locked(outcome.file.string() + ".lock");
  const std::optional<Run> old = load_baseline(outcome.file);
  const Run nothing;
  const Run& before = old ? *old : nothing;
  const auto old_hashes = row_hashes(before);
  for (const auto& [key, hash] : row_hashes(run)) {
    if (!chosen.contains(key)) continue;
    const auto found = old_hashes.find(key);
    outcome.rows.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key),
                            found == old_hashes.end() ? "" : found->second, hash});
  }
  auto row_of_cell = rows_of_cells(before);
  row_of_cell.merge(rows_of_cells(run));
  ordered_json accepted = old ? read_json(outcome.file).at("accepted") : ordered_json::array();
  accepted.push_back(entry_json(run, acceptance, outcome));
  const ordered_json json{
      {"schema", kSchemaVersion},
      {"suite", run.info->value("suite", "")},
      {"profile", run.info->value("profile", "")},
      {"machine", run.cells.front().machine},
      {"accepted", std::move(accepted)},
      {"info", *run.info},
      {"cells", json_list(merged(before.cells, run.cells, chosen, key_of))},
      {"metrics",
       json_list(merged(before.metrics, run.metrics, chosen, [&](const MetricRecord& score) {
         const auto found = row_of_cell.find(score.cell);
         return found == row_of_cell.end() ? RowKey{} : found->second;
       }))}};
  base::write_text_file(outcome.file, json.dump(1) + "\n");
  return outcome;
}

}  // namespace results::gates
