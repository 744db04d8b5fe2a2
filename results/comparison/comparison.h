#pragma once

#include <string>
#include <vector>

#include "results/comparison/row_changes.h"
#include "results/run_values.h"
#include "results/statistics.h"

/// What changed between two runs of a suite: an earlier one, the baseline, and a later one.
///
/// Reads stored results alone. Times differ by machine noise and are compared over repetitions,
/// scores differ by the seeds of the estimator and are compared seed by seed.
namespace results::comparison {

struct Rules {
  double alpha = 0.01;        ///< share of false alarms among changes, over all quantities together
  double time_effect = 0.05;  ///< least relative change of a time that counts
  double score_effect = 0.05;
  bool is_by_canary = false;  ///< times are set against those of the canary, row by row
};

/// Ratios of a method's times, or of a score, over scenes.
struct Overall {
  std::string method;
  std::string budget;
  std::string quantity;
  Estimate ratio;  ///< geometric mean; `count` scenes
};

struct Comparison {
  std::vector<Change> changes;  ///< rows in the order of the later run, times, then scores
  /// Stages of rows whose time changed, by how much each moved; p adjusted within the row.
  std::vector<Change> stages;
  std::vector<Overall> overall;  ///< of methods with several scenes
  std::vector<std::string> notes;

  std::size_t count(Verdict verdict) const;
};

/// Pairs rows by scene, method and budget.
///
/// Times: total_s (of sequences first.total_s and next_frame_s), where measured new_view_s: medians
/// over repetitions; a change is significant by Welch's test of the logarithms, adjusted, and by
/// the rank-sum test. Scores: against `own` and `full`, means over seeds that both runs have,
/// paired t test of the logarithms' differences (of the differences themselves if a score is not
/// above 0); renderers without a random seed differ for certain. A failure that was none before is
/// worse.
Comparison compare(const RunValues& before, const RunValues& after, const Rules& rules);

}  // namespace results::comparison
