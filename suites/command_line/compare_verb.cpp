#include <ostream>

#include <nlohmann/json.hpp>

#include "results/comparison/comparison.h"
#include "results/comparison/comparison_output.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/gate_verdicts.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

namespace {

using results::comparison::Comparison;
using results::comparison::Verdict;

int code_of(const Comparison& comparison, bool strict) {
  const std::size_t compared = comparison.count(Verdict::worse) +
                               comparison.count(Verdict::better) + comparison.count(Verdict::same) +
                               comparison.count(Verdict::inconclusive);
  const bool is_open = strict && comparison.count(Verdict::inconclusive) > 0;
  return most_important({compared == 0 ? kNothingMeasured : kAsExpected,
                         comparison.count(Verdict::worse) > 0 ? kGateFailed : kAsExpected,
                         is_open ? kInconclusive : kAsExpected});
}

void print_text(const Comparison& comparison, bool only_changed, Console& console) {
  console.out << results::to_text(change_table(comparison, only_changed)) << '\n';
  if (!comparison.stages.empty()) {
    console.out << results::to_text(stage_table(comparison)) << '\n';
  }
  if (!comparison.overall.empty()) {
    console.out << results::to_text(overall_table(comparison)) << '\n';
  }
}

int compare_by_gates(const results::Run& before, const results::Run& after,
                     const CompareArguments& arguments, Console& console) {
  const results::gates::GateReport report = gates_against(before, after);
  if (report.gates.empty()) {
    throw base::InputError({(after.folder / "run.json").string()}, "the run's suite has no gates");
  }
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"before", before.folder.string()},
                         {"after", after.folder.string()},
                         {"gates", results::gates::to_json(report)}});
  } else {
    console.out << results::to_text(gate_table(report, !arguments.only_changed)) << "\nbefore  "
                << before.folder.string() << "\nafter   " << after.folder.string() << '\n';
  }
  const bool is_measured =
      report.count(results::gates::Outcome::not_measured) < report.entries.size();
  return most_important(
      {is_measured ? kAsExpected : kNothingMeasured, gate_code(report, arguments.strict)});
}

}  // namespace

int run_compare(const CompareArguments& arguments, Console& console) {
  const std::filesystem::path root = results::results_root(arguments.results);
  const results::Run after = results::load_run(results::find_run(root, arguments.after));
  const results::Run before = arguments.before == "baseline"
                                  ? require_baseline(root, after)
                                  : results::load_run(results::find_run(root, arguments.before));
  if (arguments.gates) return compare_by_gates(before, after, arguments, console);
  results::comparison::Rules rules;
  rules.alpha = arguments.alpha.value_or(rules.alpha);
  rules.time_effect = arguments.time_effect.value_or(rules.time_effect);
  rules.score_effect = arguments.score_effect.value_or(rules.score_effect);
  rules.is_by_canary = arguments.by_canary;
  const Comparison comparison =
      results::comparison::compare(results::RunValues(before), results::RunValues(after), rules);
  if (arguments.json) {
    nlohmann::ordered_json json{{"schema", results::kSchemaVersion},
                                {"status", "ok"},
                                {"before", before.folder.string()},
                                {"after", after.folder.string()},
                                {"alpha", rules.alpha},
                                {"time_effect", rules.time_effect},
                                {"score_effect", rules.score_effect},
                                {"by_canary", rules.is_by_canary}};
    json.update(results::comparison::to_json(comparison));
    print_json(console, json);
  } else {
    print_text(comparison, arguments.only_changed, console);
    console.out << "before  " << before.folder.string() << "\nafter   " << after.folder.string()
                << '\n';
  }
  return code_of(comparison, arguments.strict);
}

}  // namespace suites::command_line
