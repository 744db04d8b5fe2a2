#pragma once

#include <span>

namespace base {

/// Quantile of a sample with linear interpolation between order statistics (Hyndman & Fan 1996,
/// type 7, the default of R and NumPy).
///
/// @param values  any order, at least one, no NaN
/// @param q       in [0, 1]
double quantile(std::span<const double> values, double q);

/// The same of values in rising order, for several quantiles of one sample.
double quantile_of_sorted(std::span<const double> sorted, double q);

/// The 0.5 quantile. @param values at least one
double median(std::span<const double> values);

}  // namespace base
