#include "results/gates/run_gates.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/document.h"
#include "perception/base/errors.h"
#include "results/gates/baseline.h"
#include "results/run_values.h"

namespace results::gates {

namespace {

/// As the suite said when the run began; a run of an older version has none.
std::vector<Gate> stored_gates(const Run& run) {
  const auto gates = run.info->find("gates");
  if (gates == run.info->end()) return {};
  const std::string file = (run.folder / "run.json").string();
  return read_gates(base::parse_document(gates->dump(), file));
}

std::string how_to_accept(const std::filesystem::path& file, const Run& run) {
  return fmt::format("there is no baseline {}; make one with `discern accept {} --reason TEXT`",
                     file.string(), run.folder.filename().string());
}

}  // namespace

GateReport judged_gates(const std::filesystem::path& results_root, const Run& run) {
  const bool needs_baseline = std::ranges::any_of(stored_gates(run), &Gate::needs_baseline);
  const std::filesystem::path file = baseline_file(results_root, run);
  const std::optional<Run> baseline = needs_baseline ? load_baseline(file) : std::optional<Run>();
  if (!baseline) {
    return check_gates(stored_gates(run), nullptr, RunValues(run), how_to_accept(file, run));
  }
  return gates_against(*baseline, run);
}

GateReport gates_against(const Run& before, const Run& after) {
  return gates_against(before, after, stored_gates(after));
}

GateReport gates_against(const Run& before, const Run& after, const std::vector<Gate>& gates) {
  const RunValues values(after);
  const RunValues earlier(before);
  return check_gates(gates, &earlier, values, "");
}

GateReport unjudged_gates(const Run& run, const std::string& reason) {
  GateReport report;
  report.gates = stored_gates(run);
  if (!report.gates.empty()) report.notes.push_back(reason);
  return report;
}

Run require_baseline(const std::filesystem::path& results_root, const Run& run) {
  const std::filesystem::path file = baseline_file(results_root, run);
  std::optional<Run> baseline = load_baseline(file);
  if (!baseline) throw base::InputError(how_to_accept(file, run));
  return std::move(*baseline);
}

}  // namespace results::gates
