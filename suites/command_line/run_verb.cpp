#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/html_report/html_report.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "results/run_summary.h"
#include "results/tables.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/interrupt.h"
#include "suites/command_line/plan_output.h"
#include "suites/command_line/progress_display.h"
#include "suites/command_line/verbs.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

namespace {

std::string status_text(int code) {
  switch (code) {
    case kAsExpected:
      return "ok";
    case kInterrupted:
      return "interrupted";
    case kNothingMeasured:
      return "nothing_measured";
    default:
      return "failed";
  }
}

nlohmann::ordered_json outcome_json(const RunOutcome& outcome, const std::string& report) {
  return {{"schema", results::kSchemaVersion},
          {"status", status_text(exit_code_of(outcome))},
          {"run", outcome.run_folder.string()},
          {"report", report},
          {"cells", outcome.cells},
          {"failed", outcome.failed_cells},
          {"skipped", outcome.skipped_cells},
          {"finished_repetitions", outcome.finished_repetitions},
          {"interrupted", outcome.was_interrupted}};
}

void print_outcome(const RunOutcome& outcome, const results::Run& run, const std::string& report,
                   Console& console) {
  console.out << results::to_text(results::summary_table(results::summarize(run)))
              << fmt::format("\n{} cells, {} failed, {} skipped, {} repetitions finished\n",
                             outcome.cells, outcome.failed_cells, outcome.skipped_cells,
                             outcome.finished_repetitions)
              << "run     " << outcome.run_folder.string() << "\nreport  " << report << '\n';
}

}  // namespace

int run_run(const RunArguments& arguments, Console& console) {
  const Suite suite = select_suite(arguments.selection);
  if (arguments.dry_run) {
    const PlannedSuite planned = plan_suite(suite, arguments.selection.filter);
    return print_plan(planned, arguments.results, arguments.json, console);
  }

  RunOptions options;
  options.results_root = results::results_root(arguments.results);
  options.force = arguments.force;
  options.filter = arguments.selection.filter;
  options.threads = arguments.threads;
  options.platform = arguments.device;
  options.command = arguments.command;
  handle_interrupts(OnInterrupt::stop_soon);
  RunOutcome outcome;
  {
    ProgressDisplay display(console);
    outcome = run_suite(suite, options, [&display](const Progress& p) { display.show(p); });
  }
  const results::Run run = results::load_run(outcome.run_folder);
  const std::string report = results::html_report::write_report(run).string();
  if (arguments.json) {
    print_json(console, outcome_json(outcome, report));
  } else {
    print_outcome(outcome, run, report, console);
  }
  return exit_code_of(outcome);
}

}  // namespace suites::command_line
