#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Where a series of numbers changed its level.
namespace results::history {

struct Step {
  std::size_t at = 0;   ///< index of the first value of the new level
  double before = 0.0;  ///< median of the level before
  double after = 0.0;
};

/// What is known of a value by itself.
struct ValueInterval {
  double low = 0.0;
  double high = 0.0;
};

/// The levels that make the sum of absolute distances from their medians, plus a price per step,
/// least; found exactly by dynamic programming over where the last level begins.
///
/// Distances are of logarithms if all values are above 0. The price is 2 b ln n (ours: twice the
/// Bayesian information criterion of Schwarz 1978, doi:10.1214/aos/1176344136, for Laplace noise of
/// scale b), with b from the median difference of neighbours, so that steps do not widen it. A
/// level holds at least two values: a single outlier, the newest value too, is no step.
/// @param values        finite, in order of time
/// @param least_effect  steps of a smaller relative change (absolute, where a value is not above
///                      0) are none
/// @param intervals     of the values, or none: levels whose intervals, the median of the lower and
///                      that of the upper ends, meet are one level, however evenly they are kept
/// @return by rising index; none for fewer than four values
std::vector<Step> find_steps(std::span<const double> values, double least_effect,
                             std::span<const ValueInterval> intervals = {});

}  // namespace results::history
