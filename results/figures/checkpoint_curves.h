#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "results/figures/figure_run.h"

namespace results::figures {

/// How a score fell while one seed of a row was rendered.
struct CheckpointCurve {
  std::uint64_t seed = 1;
  std::vector<std::pair<double, double>> points;  ///< seconds, score
};

/// One curve per seed that has scores of its checkpoints.
std::vector<CheckpointCurve> checkpoint_curves(const FigureRun& run, std::size_t row,
                                               const Quantity& score);

}  // namespace results::figures
