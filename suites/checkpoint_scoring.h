#pragma once

#include <cstddef>
#include <vector>

#include "suites/scoring.h"

namespace suites {

/// Scores the checkpoints of still cells, so that one render gives a whole convergence curve
/// (`measure: {convergence: true}`). Image metrics only, against the own transport and `full`.
///
/// @param known  scores that need not be made again: same reference, metric version and viewing
///   conditions
/// @return how many there were to make, all made or among the outcome's failures
/// @throws Interrupted
std::size_t score_checkpoints(const ScoringInput& input,
                              const std::vector<results::CheckpointScore>& known,
                              results::RunFolder& folder, ProgressMeter& meter,
                              ScoringOutcome& outcome);

/// Scores that `score_checkpoints` would make.
std::size_t missing_checkpoint_scores(const ScoringInput& input,
                                      const std::vector<results::CheckpointScore>& known);

}  // namespace suites
