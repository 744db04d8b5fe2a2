#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/comparison/row_pairs.h"
#include "results/run_values.h"
#include "results/statistics.h"
#include "results/tables.h"

/// One quantity of one row in two runs: what it was, what it is, and whether noise explains it.
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
  std::optional<Estimate> ratio;  ///< after / before, 95 % interval
  std::optional<double> p;        ///< of no change
  std::optional<double> q;        ///< p adjusted for all quantities together
  /// Of times as they were measured: how much longer the canary took in the same row.
  std::optional<double> machine_ratio;
  bool is_rank_significant = true;  ///< of times: what the rank-sum test says of it at alpha
  Verdict verdict = Verdict::inconclusive;
  std::string reason;  ///< what a verdict rests on, or how to come to one
};

struct ComparedRuns {
  const RunValues& before;
  const RunValues& after;
  /// Times of the later run are divided by how much longer its canary took in the same row.
  bool is_by_canary = false;
};

/// Median time of the canary in the records of a row; nothing if none has it.
std::optional<double> canary_of(const Run& run, const SummaryRow& row);

/// What a row is and which quantity of it, without values.
Change empty_change(const RowPair& pair, const Quantity& quantity);

/// The times and stages of a run by name.
Quantity time_quantity(const std::string& name, bool is_first_frame);
Quantity stage_quantity(const std::string& name);
Quantity score_quantity(const std::string& metric, const std::string& against);

/// Why nothing of a row can be compared: a run lacks it, it failed, or pictures and scenes differ.
/// A failure that was none before is worse. Nothing if its numbers can be.
std::optional<Change> obstacle(const ComparedRuns& runs, const RowPair& pair);

/// A time, a stage, a counter: medians over repetitions; p by Welch's test of the logarithms, and
/// the rank-sum test at alpha. Welch's test has the power to stay significant among many rows, the
/// rank-sum test holds whatever the distribution is: a change needs both.
/// @return nothing if a run lacks it, or has values that are not above 0
std::optional<Change> time_change(const ComparedRuns& runs, const RowPair& pair,
                                  const Quantity& quantity, double alpha);

/// A score: means over the seeds that both runs have, p by the paired t test of the logarithms'
/// differences (of the differences themselves if a score is not above 0); without random numbers
/// any change is certain.
/// @return nothing if neither run has it; `not_measured` if one of them lacks a finite one
std::optional<Change> score_change(const ComparedRuns& runs, const RowPair& pair,
                                   const Quantity& quantity);

/// q of all changes that have a p, for all of them together.
void adjust_for_false_discovery(std::vector<Change>& changes);

/// Gives a verdict to a change that has none yet.
/// @param effect  least relative change that counts
void judge(Change& change, double alpha, double effect);

}  // namespace results::comparison
