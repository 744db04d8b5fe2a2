#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/run_values.h"
#include "results/statistics.h"
#include "results/tables.h"

/// What changed between two runs of a suite: an earlier one, the baseline, and a later one.
///
/// Reads stored results alone. Times differ by machine noise and are compared over repetitions,
/// scores differ by the seeds of the estimator and are compared seed by seed.
namespace results::comparison {

enum class Verdict {
  worse,         ///< significant, and at least the least effect
  better,        ///< likewise
  same,          ///< the whole interval lies within the least effect, or the values are equal
  inconclusive,  ///< neither
  invalid,       ///< may not be compared: other machine, other settings, failures before
  not_measured   ///< in one of the runs only
};
std::string to_string(Verdict verdict);

struct Rules {
  double alpha = 0.01;        ///< share of false alarms among changes, over all quantities together
  double time_effect = 0.05;  ///< least relative change of a time that counts
  double score_effect = 0.05;
};

/// A quantity of a row: its estimates before and after.
struct Change {
  std::string scene;
  std::string method;
  std::string budget;
  std::string quantity;  ///< as claims and figures name it: "total_s", "flip@full"
  std::string unit;
  Direction better = Direction::lower;
  std::optional<Estimate> before;
  std::optional<Estimate> after;
  std::optional<Estimate> ratio;    ///< after / before, 95 % interval
  std::optional<double> p;          ///< of no change
  std::optional<double> q;          ///< p adjusted for all quantities together
  bool is_rank_significant = true;  ///< of times: what the rank-sum test says of it at alpha
  Verdict verdict = Verdict::inconclusive;
  std::string reason;  ///< what a verdict rests on, or how to come to one
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
