#include "suites/command_line/gate_verdicts.h"

#include <algorithm>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/document.h"
#include "results/gates/baseline.h"
#include "results/gates/junit.h"
#include "results/run_values.h"
#include "suites/command_line/exit_codes.h"

namespace suites::command_line {

namespace {

using results::gates::Gate;
using results::gates::GateReport;
using results::gates::Outcome;

/// As the suite said when the run began; a run of an older version has none.
std::vector<Gate> stored_gates(const results::Run& run) {
  const auto gates = run.info->find("gates");
  if (gates == run.info->end()) return {};
  const std::string file = (run.folder / "run.json").string();
  return results::gates::read_gates(base::parse_document(gates->dump(), file));
}

std::string how_to_accept(const std::filesystem::path& file, const results::Run& run) {
  return fmt::format("there is no baseline {}; make one with `discern accept {} --reason TEXT`",
                     file.string(), run.folder.filename().string());
}

}  // namespace

GateReport judged_gates(const std::filesystem::path& results_root, const results::Run& run) {
  const bool needs_baseline = std::ranges::any_of(stored_gates(run), &Gate::needs_baseline);
  const std::filesystem::path file = results::gates::baseline_file(results_root, run);
  const std::optional<results::Run> baseline =
      needs_baseline ? results::gates::load_baseline(file) : std::optional<results::Run>();
  if (!baseline) {
    return check_gates(stored_gates(run), nullptr, results::RunValues(run),
                       how_to_accept(file, run));
  }
  return gates_against(*baseline, run);
}

GateReport gates_against(const results::Run& before, const results::Run& after) {
  return gates_against(before, after, stored_gates(after));
}

GateReport gates_against(const results::Run& before, const results::Run& after,
                         const std::vector<Gate>& gates) {
  const results::RunValues values(after);
  const results::RunValues earlier(before);
  return check_gates(gates, &earlier, values, "");
}

GateReport unjudged_gates(const results::Run& run, const std::string& reason) {
  GateReport report;
  report.gates = stored_gates(run);
  if (!report.gates.empty()) report.notes.push_back(reason);
  return report;
}

results::Run require_baseline(const std::filesystem::path& results_root, const results::Run& run) {
  const std::filesystem::path file = results::gates::baseline_file(results_root, run);
  std::optional<results::Run> baseline = results::gates::load_baseline(file);
  if (!baseline) throw base::InputError(how_to_accept(file, run));
  return std::move(*baseline);
}

int gate_code(const GateReport& report, bool strict) {
  if (report.gates.empty()) return kAsExpected;
  switch (report.overall()) {
    case Outcome::failed:
      return kGateFailed;
    case Outcome::inconclusive:
    case Outcome::not_measured:
      return strict ? kInconclusive : kAsExpected;
    case Outcome::passed:
      break;
  }
  return kAsExpected;
}

void print_gates(const GateReport& report, Console& console) {
  if (report.gates.empty()) return;
  const results::Table table = gate_table(report, false);
  console.out << '\n';
  if (!table.rows.empty()) {
    console.out << results::to_text(table);
    return;
  }
  for (const std::string& note : table.notes) console.out << note << '\n';
}

void write_junit(const results::Run& run, const GateReport& report, const std::string& copy) {
  const std::string xml = results::gates::junit_xml(results::RunValues(run), report);
  base::write_text_file(run.folder / "junit.xml", xml);
  if (!copy.empty()) base::write_text_file(copy, xml);
}

}  // namespace suites::command_line
