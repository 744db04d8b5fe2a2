#include <fmt/format.h>

#include "suites/command_line/verb_spec.h"

/// Verbs on what is stored already, and those of a night.
namespace suites::command_line {

namespace {

void add_accept_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<AcceptArguments>(
      verbs, "accept", "make a run the baseline that later ones are compared with");
  add_run(*verb, a->run);
  verb->add_option("--reason", a->reason, "why; kept with the baseline")->required();
  verb->add_option("--author", a->author, "who (default: the user's name)");
  verb->add_option("--filter", a->filter, "only rows whose scene, method or cell match")
      ->type_name("REGEX");
  add_results(*verb, a->results);
}

void add_compare_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<CompareArguments>(
      verbs, "compare", "what changed between two runs of a suite, beyond their noise");
  verb->add_option("before", a->before,
                   "earlier run: folder, id, suite name, \"last\" or \"baseline\"")
      ->type_name("RUN")
      ->required();
  verb->add_option("after", a->after, "later run")->type_name("RUN")->required();
  add_share(*verb, "--alpha", a->alpha, "false alarms among changes (default: 1%)");
  add_share(*verb, "--time-effect", a->time_effect,
            "least change of a time that counts (default: 5%)");
  add_share(*verb, "--score-effect", a->score_effect,
            "least change of a score that counts (default: 5%)");
  verb->add_flag("--gates", a->gates, "judge by the gates of the later run's suite alone");
  verb->add_flag("--canary", a->by_canary,
                 "divide later times by how much longer the canary took, row by row");
  verb->add_flag("--only-changed", a->only_changed, "print better, worse and invalid rows alone");
  verb->add_flag("--strict", a->strict, "exit 5 if a row is inconclusive");
  add_results(*verb, a->results);
}

void add_figure_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<FigureArguments>(verbs, "figure", "draw the figures of a suite");
  add_suite(*verb, a->suite);
  verb->add_option("id", a->id, "this figure only");
  add_run_option(*verb, a->run);
  verb->add_option("--out", a->out, "folder (default: figures/ of the run)")->type_name("DIR");
  add_list(*verb, "--format", a->formats, "pdf | svg | png (default: pdf and svg)");
  add_results(*verb, a->results);
}

void add_view_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ViewArguments>(verbs, "view", "show a run's pictures in tev, which must be running");
  add_run(*verb, a->run);
  verb->add_option("--filter", a->filter, "only rows whose scene, method or budget match")
      ->type_name("REGEX");
  verb->add_option("--viewer", a->viewer, "where it listens")
      ->type_name("HOST:PORT")
      ->capture_default_str();
  verb->add_flag("--send", a->sends_pixels,
                 "send pixels, to a viewer that cannot read the files itself");
  add_results(*verb, a->results);
}

void add_table_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<TableArguments>(verbs, "table", "a run's numbers as text, Markdown, CSV or LaTeX");
  add_run(*verb, a->run);
  add_table_format(*verb, a->format);
  verb->add_option("--rankings", a->rankings,
                   "only pairs of rows that two scores order differently: relmse,flip@full")
      ->type_name("A,B");
  verb->add_option("--filter", a->filter, "only rows whose scene, method or budget match")
      ->type_name("REGEX");
  add_results(*verb, a->results);
}

void add_cheapest_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<CheapestArguments>(
      verbs, "cheapest", "the least time whose error stays below a visible threshold");
  add_run(*verb, a->run);
  verb->add_option("--metric", a->metric, "score to stay below the limit")
      ->type_name("METRIC")
      ->capture_default_str();
  verb->add_option("--below", a->below, "greatest score that counts, a number or a percentage")
      ->required();
  verb->add_option("--against", a->against, "own | full (default: full)")
      ->one_of({"own", "full"}, "truth");
  add_results(*verb, a->results);
}

void add_history_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<HistoryArguments>(
      verbs, "history", "a quantity over all runs of a suite, and where it stepped");
  verb->add_option("suite", a->suite, "name of the suite")->type_name("SUITE")->required();
  verb->add_option(
      "--quantity", a->quantity,
      "as claims name it: total_s, gather, flip@full (default: total_s, of --html all)");
  verb->add_option("--html", a->html, "also write an offline page with a line per row")
      ->type_name("FILE");
  verb->add_option("--filter", a->filter, "only rows whose scene, method or budget match")
      ->type_name("REGEX");
  verb->add_option("--profile", a->profile, "default: that of the newest run");
  verb->add_option("--machine", a->machine, "default: this machine");
  add_integer(*verb, "--last", a->last, 1, "only so many of the newest runs");
  verb->add_flag("--rebuild", a->rebuild, "read all runs again, not only those that are new");
  add_results(*verb, a->results);
}

void add_bisect_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<BisectArguments>(
      verbs, "bisect", "the commit from which on a suite became slower or worse");
  add_suite(*verb, a->suite);
  verb->add_option("good", a->good, "revision that was good")->required();
  verb->add_option("bad", a->bad, "later revision that is not")->required();
  verb->add_option("--quantity", a->quantity,
                   "as claims name it: total_s, stage.gather, flip@full (default: the suite's "
                   "gates)");
  add_share(*verb, "--worse-by", a->worse_by, "least change of the quantity (default: 5%)");
  verb->add_option("--profile", a->profile, "sizes and counts of this profile");
  verb->add_option("--filter", a->filter, "only cells whose scene, method or name match")
      ->type_name("REGEX");
  verb->add_option("--source", a->source, "git repository (default: the checkout)")
      ->type_name("DIR");
  verb->add_option("--build", a->build,
                   "shell command that makes build/discern in a checkout (default: "
                   "suites/set_up core build)")
      ->type_name("COMMAND");
  add_results(*verb, a->results);
}

void add_merge_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<MergeArguments>(
      verbs, "merge", "make one run of several that each did a part of the same suite");
  verb->add_option("runs", a->runs, "run folders or ids, two or more")
      ->type_name("RUN")
      ->required();
  add_results(*verb, a->results);
}

void add_doctor_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<DoctorArguments>(
      verbs, "doctor", "is this machine fit to measure on, and what would make it so");
  verb->add_flag("--strict", a->strict, "exit 5 if something would disturb times");
  add_results(*verb, a->results);
}

}  // namespace

void add_results_verbs(Verbs& verbs) {
  add_accept_verb(verbs);
  add_compare_verb(verbs);
  add_figure_verb(verbs);
  add_view_verb(verbs);
  add_table_verb(verbs);
  add_cheapest_verb(verbs);
  add_history_verb(verbs);
  add_bisect_verb(verbs);
  add_merge_verb(verbs);
  add_doctor_verb(verbs);
}

}  // namespace suites::command_line
