#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "results/run_summary.h"
#include "results/tables.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/gate_verdicts.h"
#include "suites/command_line/interrupt.h"
#include "suites/command_line/plan_output.h"
#include "suites/command_line/progress_display.h"
#include "suites/command_line/psychophysics_verbs.h"
#include "suites/command_line/run_outcome.h"
#include "suites/command_line/verbs.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

RunOptions run_options(const RunArguments& arguments) {
  RunOptions options;
  options.results_root = results::results_root(arguments.results);
  options.force = arguments.force;
  options.filter = arguments.selection.filter;
  options.threads = arguments.threads;
  options.jobs = arguments.jobs;
  options.platform = arguments.device;
  options.command = arguments.command;
  return options;
}

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

}  // namespace

nlohmann::ordered_json outcome_json(const RunOutcome& outcome, const std::string& report) {
  return {{"schema", results::kSchemaVersion},
          {"status", status_text(exit_code_of(outcome))},
          {"run", outcome.run_folder.string()},
          {"report", report},
          {"cells", outcome.cells},
          {"failed", outcome.failed_cells},
          {"skipped", outcome.skipped_cells},
          {"finished_repetitions", outcome.finished_repetitions},
          {"new_repetitions", outcome.new_repetitions},
          {"failed_references", outcome.failed_references},
          {"failed_scores", outcome.failed_scores},
          {"interrupted", outcome.was_interrupted}};
}

namespace {

void print_outcome(const RunOutcome& outcome, const results::Run& run, const std::string& report,
                   Console& console) {
  console.out << results::to_text(results::summary_table(results::summarize(run)))
              << fmt::format("\n{} cells, {} failed, {} skipped, {} repetitions finished\n",
                             outcome.cells, outcome.failed_cells, outcome.skipped_cells,
                             outcome.finished_repetitions)
              << "run     " << outcome.run_folder.string() << "\nreport  " << report << '\n';
}

/// No run folder is made for nothing.
int say_nothing_matches(const std::string& filter, bool as_json, Console& console) {
  if (as_json) print_json(console, outcome_json({}, ""));
  print_note(console, fmt::format("nothing to measure: no cell matches --filter \"{}\"", filter));
  return kNothingMeasured;
}

/// What a person should know beside the table.
void print_notes(const RunOutcome& outcome, Console& console) {
  if (outcome.failed_references > 0) {
    print_note(console, fmt::format("{} references could not be made; their methods have no scores "
                                    "(reasons: run.json and the report)",
                                    outcome.failed_references));
  }
  if (outcome.failed_scores > 0) {
    print_note(console, fmt::format("{} cells or scores could not be scored; reasons: "
                                    "\"score_failures\" in run.json",
                                    outcome.failed_scores));
  }
  const bool is_resumed = outcome.new_repetitions == 0 && outcome.finished_repetitions > 0;
  if (is_resumed && !outcome.was_interrupted) {
    print_note(console, "every repetition was finished before; --force makes a new run");
  }
}

/// What cannot be judged is told; the run's own results are there all the same.
results::gates::GateReport judged_or_told(const std::filesystem::path& root,
                                          const results::Run& run, bool was_interrupted,
                                          int& code) {
  if (was_interrupted) {
    return unjudged_gates(run, "the run was interrupted: its gates are not judged");
  }
  try {
    return judged_gates(root, run);
  } catch (const base::InputError& error) {
    code = kInputError;
    return unjudged_gates(run, error.what());
  }
}

}  // namespace

int run_run(const RunArguments& arguments, Console& console) {
  if (is_psychophysics(arguments.selection)) return run_psychophysics_suite(arguments, console);
  const Suite suite = select_suite(arguments.selection);
  if (arguments.dry_run) {
    const PlannedSuite planned = plan_suite(suite, arguments.selection.filter);
    return print_plan(planned, arguments.selection, arguments.results, arguments.json, console);
  }

  const std::string& filter = arguments.selection.filter;
  if (!filter.empty() && plan_suite(suite, filter).plan.cells.empty()) {
    return say_nothing_matches(filter, arguments.json, console);
  }

  // A file that cannot be written is told before hours of work, not after.
  if (!arguments.junit.empty()) base::write_text_file(arguments.junit, "<testsuites/>\n");
  const RunOptions options = run_options(arguments);
  if (options.jobs > 1) {
    print_note(console, fmt::format("{} jobs at once: times suffer, and are compared with those of "
                                    "{} jobs alone",
                                    options.jobs, options.jobs));
  }
  handle_interrupts(OnInterrupt::stop_soon);
  RunOutcome outcome;
  {
    ProgressDisplay display(console);
    outcome = run_suite(suite, options, [&display](const Progress& p) { display.show(p); });
  }
  const results::Run run = results::load_run(outcome.run_folder);
  const bool is_current =
      outcome.new_repetitions == 0 && results::html_report::is_report_current(run);
  const std::string report = is_current ? results::html_report::report_file(run).string()
                                        : write_run_report(run, console).index.string();
  int gates_code = kAsExpected;
  const results::gates::GateReport gates =
      judged_or_told(options.results_root, run, outcome.was_interrupted, gates_code);
  write_junit(run, gates, arguments.junit);
  if (arguments.json) {
    nlohmann::ordered_json json = outcome_json(outcome, report);
    json["gates"] = results::gates::to_json(gates);
    print_json(console, json);
  } else {
    print_outcome(outcome, run, report, console);
    print_gates(gates, console);
  }
  print_notes(outcome, console);
  return most_important({exit_code_of(outcome), gate_code(gates, arguments.strict), gates_code});
}

}  // namespace suites::command_line
