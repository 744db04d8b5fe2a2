#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

/// Statistics over repetitions and seeds. Raw samples are stored; this is computed when asked for.
///
/// Sources: Efron & Tibshirani, An Introduction to the Bootstrap, 1993;
/// Abramowitz & Stegun, Handbook of Mathematical Functions, 1964.
namespace results {

/// A number with its uncertainty.
struct Estimate {
  double value = 0.0;
  double low = 0.0;  ///< 95 % interval; equal to value if it cannot be had from one sample
  double high = 0.0;
  std::size_t count = 0;
};

/// With fewer values no 95 % interval of a median can be had without assuming a distribution: even
/// their whole range covers it with probability 1 - 2^(1-n) only, 0.94 for 5 values (each value
/// lies on either side of the median with probability 1/2).
inline constexpr std::size_t kFewestForMedianInterval = 6;

/// Median with a percentile-bootstrap interval (Efron & Tibshirani 1993, ch. 13); of fewer than
/// kFewestForMedianInterval values the interval is their whole range. The same values and seed
/// give the same interval on every machine.
/// @param values  at least one, finite
Estimate median_with_interval(std::span<const double> values, std::uint64_t seed = 1,
                              int resamples = 2000, double confidence = 0.95);

/// The median of values that are there several times.
/// @param sorted  at least one, finite
/// @param counts  how often each is there, of the same length; their sum is that length
double median_of_counts(std::span<const double> sorted, std::span<const std::uint16_t> counts);

/// Mean with Student's t interval; one value: no interval.
/// @param values  at least one, finite
Estimate mean_with_interval(std::span<const double> values, double confidence = 0.95);

/// Half-width x with P(|T| <= x) = confidence for Student's t distribution.
///
/// @param confidence          in (0, 1)
/// @param degrees_of_freedom  >= 1
/// The distribution is the finite series for whole degrees of freedom, Abramowitz & Stegun
/// eqs. 26.7.3 and 26.7.4 (equation numbers from memory; checked against printed quantiles),
/// inverted by bisection to full double precision.
double student_t_half_width(double confidence, int degrees_of_freedom);

/// y = intercept + slope x.
struct Line {
  double intercept = 0.0;
  double slope = 0.0;
};

/// The line of least squared distances in y; nothing for fewer than two different x.
/// @param x, y  of one length, finite
std::optional<Line> least_squares_line(std::span<const double> x, std::span<const double> y);

/// Spearman's rank correlation, in [-1, 1]: Pearson's correlation of the ranks, equal values
/// sharing their mean rank; nothing if either has fewer than two different values.
/// @param x, y  of one length, finite
std::optional<double> rank_correlation(std::span<const double> x, std::span<const double> y);

}  // namespace results
