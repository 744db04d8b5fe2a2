#include <ostream>

#include <nlohmann/json.hpp>

#include "results/html_report/html_report.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/psychophysics_verbs.h"
#include "suites/command_line/run_outcome.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

int run_report(const ReportArguments& arguments, Console& console) {
  const std::filesystem::path root = results::results_root(arguments.results);
  const std::filesystem::path folder = results::find_run(root, arguments.run);
  if (results::run_kind(folder) == "psychophysics") {
    return report_psychophysics(folder, arguments.json, console);
  }
  const results::Run run = results::load_run(folder);
  const std::filesystem::path report = results::html_report::write_report(run);
  return print_report({run.folder.string(), report.string(), run.cells.size(), run.metrics.size(),
                       run.unreadable_lines},
                      arguments.json, console);
}

int print_report(const WrittenReport& written, bool as_json, Console& console) {
  if (as_json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"run", written.run},
                         {"report", written.report},
                         {"repetitions", written.repetitions},
                         {"scores", written.scores},
                         {"unreadable_lines", written.unreadable_lines}});
    return kAsExpected;
  }
  if (written.unreadable_lines > 0) {
    print_note(console,
               std::to_string(written.unreadable_lines) + " unreadable lines were left out");
  }
  console.out << written.report << '\n';
  return kAsExpected;
}

}  // namespace suites::command_line
