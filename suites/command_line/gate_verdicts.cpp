#include "suites/command_line/gate_verdicts.h"

#include <ostream>

#include "perception/base/atomic_file.h"
#include "results/gates/junit.h"
#include "results/run_values.h"
#include "suites/command_line/exit_codes.h"

namespace suites::command_line {

using results::gates::GateReport;
using results::gates::Outcome;

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
