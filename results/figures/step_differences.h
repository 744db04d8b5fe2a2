#pragma once

#include <cstddef>
#include <optional>

#include "results/figures/figure_run.h"

namespace results::figures {

/// The score of one row less that of another.
///
/// With at least two seeds in common: the mean of the differences of equal seeds with Student's t
/// interval; else the difference of the rows' values, with a count of 1 and no interval.
/// @return nothing if a row has no score
std::optional<Estimate> score_difference(const FigureRun& run, std::size_t row, std::size_t before,
                                         const Quantity& score);

}  // namespace results::figures
