#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "results/statistics.h"

/// Tests of whether two series of measurements differ.
namespace results::comparison {

/// Two-sided p of the rank-sum test: how often, if both series came from one distribution, their
/// values would be dealt to them as unevenly as they are, or more so.
///
/// Exact, ties included: equal values share their mean rank and all deals of the ranks are counted.
/// Above kMostExactRanks values together the normal approximation with the correction for ties.
/// Sources: Wilcoxon 1945, doi:10.2307/3001968; Mann and Whitney 1947,
/// doi:10.1214/aoms/1177730491; Lehmann 1975, Nonparametrics, Sec. 1.2 and 1.4 (sections recalled).
/// @param a, b  at least one value each, finite
double rank_sum_p(std::span<const double> a, std::span<const double> b);
inline constexpr std::size_t kMostExactRanks = 60;

/// The least p that series of these lengths can give: 2 / C(a + b, a).
double least_rank_sum_p(std::size_t a, std::size_t b);

/// Repetitions of each of two runs from which on a rank-sum test can be significant at alpha.
std::size_t fewest_repetitions(double alpha);

/// Two-sided p of Welch's t test of the logarithms: means differ, so may variances.
/// Source: Welch 1947, doi:10.1093/biomet/34.1-2.28; degrees of freedom by Welch and Satterthwaite,
/// rounded down.
/// @param a, b  at least two values each, > 0
double welch_log_p(std::span<const double> a, std::span<const double> b);

/// Two-sided p of Student's t test that the mean of differences is 0.
/// @param differences  of pairs, at least two, finite; 1 if all are 0, 0 if all are the same
double paired_t_p(std::span<const double> differences);

/// For each p the least share of false discoveries among those called significant at which it is
/// one of them.
/// Source: Benjamini and Hochberg 1995, "Controlling the False Discovery Rate",
/// doi:10.1111/j.2517-6161.1995.tb02031.x, Sec. 3.1 (step-up).
/// @param p  in [0, 1]  @return in the same order, >= p
std::vector<double> adjusted_for_false_discovery(std::span<const double> p);

/// b over a, of their medians, with a percentile-bootstrap interval in which both series are drawn
/// again by themselves; with fewer than kFewestForMedianInterval values in either, the extremes of
/// all quotients.
/// @param a, b  at least one value each, > 0
Estimate ratio_of_medians(std::span<const double> a, std::span<const double> b,
                          std::uint64_t seed = 1, int resamples = 2000);

/// Geometric mean of ratios with Student's t interval of their logarithms; one ratio: no interval.
/// @param ratios  at least one, > 0
Estimate geometric_mean(std::span<const double> ratios);

}  // namespace results::comparison
