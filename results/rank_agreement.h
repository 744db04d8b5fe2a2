#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "results/run_values.h"
#include "results/tables.h"

/// Where two scores rank the rows of a scene differently.
namespace results {

/// Two rows whose order one score has one way and the other score the other way, each beyond the
/// noise of its seeds.
struct Disagreement {
  std::size_t first = 0;   ///< index of the row that score `a` calls better
  std::size_t second = 0;  ///< of the one that score `b` does
};

struct RankAgreement {
  std::string scene;
  std::size_t rows = 0;   ///< that have both scores
  std::size_t pairs = 0;  ///< that both scores can tell apart
  std::vector<Disagreement> disagreements;
  /// Kendall's tau of the pairs that both can tell apart: 1 if they agree on all, -1 on none.
  /// Source: Kendall 1938, doi:10.1093/biomet/30.1-2.81 (pairs in doubt left out: ours).
  std::optional<double> tau;
};

/// @param a, b  scores, lower or higher better as their metrics say; two rows are told apart where
///              their 95 % intervals lie apart; a single seed has none and counts as it is
std::vector<RankAgreement> rank_agreement(const RunValues& run, const Quantity& a,
                                          const Quantity& b);

/// A row per disagreement; the notes have tau and counts of every scene.
Table rank_agreement_table(const RunValues& run, const Quantity& a, const Quantity& b);

}  // namespace results
