#include "suites/command_line/psychophysics_verbs.h"

#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "results/html_report/psychophysics_page.h"
#include "results/psychophysics/psychophysics_run.h"
#include "results/result_store.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/interrupt.h"
#include "suites/command_line/progress_display.h"
#include "suites/command_line/psychophysics_output.h"
#include "suites/command_line/run_outcome.h"
#include "suites/psychophysics/psychophysics_runner.h"
#include "suites/suite_file.h"

namespace suites::command_line {
namespace {

using psychophysics::PlannedQuestion;
using psychophysics::PsychophysicsSuite;
using results::psychophysics::PsychophysicsRun;

/// Stimuli have no scenes, seeds, repetitions or profiles.
PsychophysicsSuite read_selected(const SuiteSelection& selection) {
  const std::pair<bool, const char*> refused[] = {
      {!selection.profile.empty(), "--profile"},
      {selection.seeds.has_value(), "--seeds"},
      {selection.repetitions.has_value(), "--repetitions"},
      {!selection.scenes.empty(), "--scene"},
      {!selection.methods.empty(), "--method"},
      {!selection.metrics.empty(), "--metric"},
      {!selection.samples.empty(), "--samples"},
      {!selection.times.empty(), "--time"},
      {!selection.size.empty(), "--size"},
      {selection.reference_samples.has_value(), "--reference-samples"}};
  for (const auto& [is_given, option] : refused) {
    if (!is_given) continue;
    throw base::InputError(
        fmt::format("{} cannot be given together with suite \"{}\", which is of kind "
                    "psychophysics; accepted: --filter",
                    option, selection.suite));
  }
  return psychophysics::read_psychophysics_suite(find_suite(selection.suite));
}

int print_check(const PsychophysicsSuite& suite, const std::string& filter, bool as_json,
                Console& console) {
  const std::vector<PlannedQuestion> questions = psychophysics::plan_questions(suite, filter);
  if (as_json) {
    print_json(console, check_json(suite, questions));
  } else {
    console.out << check_text(suite, questions);
  }
  return questions.empty() ? kNothingMeasured : kAsExpected;
}

}  // namespace

bool is_psychophysics(const SuiteSelection& selection) {
  return !selection.suite.empty() &&
         psychophysics::is_psychophysics_suite(find_suite(selection.suite));
}

int check_psychophysics(const CheckArguments& arguments, Console& console) {
  return print_check(read_selected(arguments.selection), arguments.selection.filter, arguments.json,
                     console);
}

int run_psychophysics_suite(const RunArguments& arguments, Console& console) {
  const PsychophysicsSuite suite = read_selected(arguments.selection);
  const std::string& filter = arguments.selection.filter;
  if (arguments.dry_run) return print_check(suite, filter, arguments.json, console);
  if (psychophysics::plan_questions(suite, filter).empty()) {
    if (arguments.json) print_json(console, outcome_json({}, ""));
    print_note(console, fmt::format("nothing to measure: no cell matches --filter \"{}\"", filter));
    return kNothingMeasured;
  }
  handle_interrupts(OnInterrupt::stop_soon);
  RunOutcome outcome;
  {
    ProgressDisplay display(console);
    outcome = psychophysics::run_psychophysics(suite, run_options(arguments),
                                               [&display](const Progress& p) { display.show(p); });
  }
  const PsychophysicsRun run = results::psychophysics::load_psychophysics_run(outcome.run_folder);
  const std::string report = results::html_report::write_report(run).string();
  if (arguments.json) {
    nlohmann::ordered_json json = outcome_json(outcome, report);
    json["experiments"] = summary_json(run);
    print_json(console, json);
  } else {
    console.out << summary_text(run)
                << fmt::format("{} cells, {} failed, {} not a question for their model\n",
                               outcome.cells, outcome.failed_cells, outcome.skipped_cells)
                << "run     " << outcome.run_folder.string() << "\nreport  " << report << '\n';
  }
  if (outcome.new_repetitions == 0 && !outcome.was_interrupted) {
    print_note(console, "every cell was finished before; --force makes a new run");
  }
  return exit_code_of(outcome);
}

int report_psychophysics(const std::filesystem::path& run_folder, bool as_json, Console& console) {
  const PsychophysicsRun run = results::psychophysics::load_psychophysics_run(run_folder);
  const std::filesystem::path report = results::html_report::write_report(run);
  return print_report({run.folder.string(), report.string(), run.predictions.size(), 0,
                       run.unreadable_lines, false, 0},
                      as_json, console);
}

}  // namespace suites::command_line
