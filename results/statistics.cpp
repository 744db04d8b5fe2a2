#include "results/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "perception/base/quantile.h"
#include "results/student_t.h"

namespace results {

namespace {

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Places in the order of the values, from 1; equal values share the mean of theirs.
std::vector<double> ranks_of(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> ranks;
  for (const double value : values) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
    const auto below = static_cast<double>(first - sorted.begin());
    ranks.push_back(below + 0.5 * static_cast<double>(last - first + 1));
  }
  return ranks;
}

/// Of every value its place among them in ascending order, from 0.
std::vector<std::size_t> places_in_order(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<std::size_t> places(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) places[order[i]] = i;
  return places;
}

}  // namespace

double student_t_half_width(double confidence, int degrees_of_freedom) {
  assert(confidence > 0.0 && confidence < 1.0 && degrees_of_freedom >= 1);
  double low = 0.0;
  double high = 1.0;
  while (student_t_two_sided(high, degrees_of_freedom) < confidence) high *= 2.0;
  // Bisection until neighbouring doubles: at most 64 halvings.
  for (int i = 0; i < 64; ++i) {
    const double middle = 0.5 * (low + high);
    (student_t_two_sided(middle, degrees_of_freedom) < confidence ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Estimate median_with_interval(std::span<const double> values, std::uint64_t seed, int resamples,
                              double confidence) {
  assert(!values.empty() && values.size() <= std::numeric_limits<std::uint16_t>::max());
  const double median = base::median(values);
  if (values.size() < kFewestForMedianInterval) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {median, *low, *high, values.size()};
  }

  // Efron & Tibshirani 1993, ch. 13: quantiles of the medians of samples drawn with replacement.
  // The bias of the remainder is below 2^-40 for any sample of ours; the generator is the
  // standard's, so its numbers are the same everywhere.
  std::mt19937_64 random(seed);
  const std::vector<std::size_t> places = places_in_order(values);
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint16_t> counts(values.size());
  std::vector<double> medians(static_cast<std::size_t>(resamples));
  for (double& resampled_median : medians) {
    std::fill(counts.begin(), counts.end(), std::uint16_t{0});
    for (std::size_t i = 0; i < values.size(); ++i) ++counts[places[random() % values.size()]];
    resampled_median = median_of_counts(sorted, counts);
  }
  std::sort(medians.begin(), medians.end());
  const double tail = 0.5 * (1.0 - confidence);
  return {median, base::quantile(medians, tail), base::quantile(medians, 1.0 - tail),
          values.size()};
}

double median_of_counts(std::span<const double> sorted, std::span<const std::uint16_t> counts) {
  const std::size_t low_rank = (sorted.size() - 1) / 2;
  const std::size_t high_rank = sorted.size() / 2;
  std::size_t i = 0;
  std::size_t below = counts[0];
  while (below <= low_rank) below += counts[++i];
  const double low = sorted[i];
  while (below <= high_rank) below += counts[++i];
  // As base::median rounds.
  return low + 0.5 * static_cast<double>(high_rank - low_rank) * (sorted[i] - low);
}

Estimate mean_with_interval(std::span<const double> values, double confidence) {
  assert(!values.empty());
  const double count = static_cast<double>(values.size());
  const double mean = mean_of(values);
  if (values.size() == 1) return {mean, mean, mean, 1};
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double standard_error = std::sqrt(squares / (count - 1.0) / count);
  const double half_width =
      student_t_half_width(confidence, static_cast<int>(values.size()) - 1) * standard_error;
  return {mean, mean - half_width, mean + half_width, values.size()};
}

std::optional<Line> least_squares_line(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  const double mean_x = mean_of(x);
  const double mean_y = mean_of(y);
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(xx > 0.0)) return std::nullopt;
  const double slope = xy / xx;
  return Line{mean_y - slope * mean_x, slope};
}

std::optional<double> rank_correlation(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  const std::vector<double> ranks_x = ranks_of(x);
  const std::vector<double> ranks_y = ranks_of(y);
  const std::optional<Line> forth = least_squares_line(ranks_x, ranks_y);
  const std::optional<Line> back = least_squares_line(ranks_y, ranks_x);
  if (!forth || !back) return std::nullopt;
  // r^2 is the product of both regressions' slopes, which share its sign.
  return std::copysign(std::sqrt(forth->slope * back->slope), forth->slope);
}

}  // namespace results
