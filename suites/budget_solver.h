#pragma once

#include <functional>
#include <string>

#include "results/search_record.h"
#include "suites/repetition_runner.h"
#include "suites/run_plan.h"
#include "suites/score_references.h"
#include "suites/setting_search.h"

namespace suites {

/// Finds the settings at which cells meet their budgets by time or error on this machine.
///
/// A probe is one cold repetition in the cell's worker with the first seed (of a sequence its first
/// frames, judged by their median). A time is set against total_s, of a sequence next_frame_s; an
/// error is the score against the method's own transport. An equal time is the median of three
/// probes of the other method, made right before.
class BudgetSolver {
 public:
  /// The arguments must live as long as this.
  BudgetSolver(const Suite& suite, const RunPlan& plan, const ReferenceStore& store,
               RepetitionRunner& runner)
      : suite_(suite), plan_(plan), references_(plan, store), runner_(runner) {}

  /// @param cell  of the first seed, under a budget that is searched
  /// @param show  called after every probe with how many there were
  /// @return `value` where the cells can run; else the reason why not. What a renderer does wrong
  ///   is an outcome, too.
  /// @throws Interrupted
  results::SearchRecord solve(const PlannedCell& cell,
                              const std::function<void(std::size_t)>& show = {});

 private:
  struct Failure;  ///< ends a search; says why
  double time_target_s(const PlannedCell& cell);
  double median_time_s(const PlannedCell& cell);
  double measured(const PlannedCell& cell, double setting);
  double score(const PlannedCell& cell, const ProbedFrame& frame, std::size_t index);
  void check_noise_floor(const PlannedCell& cell, const SearchGoal& goal);
  SearchGoal goal_of(const PlannedCell& cell);
  perception::ViewingConditions viewing(const PlannedCell& cell) const;

  const Suite& suite_;
  const RunPlan& plan_;
  ScoreReferences references_;
  RepetitionRunner& runner_;
};

/// The setting that a cell's budget is searched with: the method's, else its samples.
SearchedSetting searched_setting(const PlannedCell& cell);

/// Gives a cell what was found for it: the setting, or the reason why it cannot run.
void apply(const results::SearchRecord& search, PlannedCell& cell);

}  // namespace suites
