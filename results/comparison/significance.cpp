#include "results/comparison/significance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "perception/base/quantile.h"
#include "results/student_t.h"

namespace results::comparison {

namespace {

/// Twice the mean ranks of all values, whole numbers: first those of a, then those of b.
std::vector<std::size_t> doubled_ranks(std::span<const double> a, std::span<const double> b) {
  std::vector<double> sorted(a.begin(), a.end());
  sorted.insert(sorted.end(), b.begin(), b.end());
  const std::vector<double> values = sorted;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::size_t> ranks;
  for (const double value : values) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
    const auto below = static_cast<std::size_t>(first - sorted.begin());
    ranks.push_back(2 * below + static_cast<std::size_t>(last - first) + 1);
  }
  return ranks;
}

/// Share of all choices of `chosen` ranks whose sum lies at least as far from the mean.
double exact_p(const std::vector<std::size_t>& ranks, std::size_t chosen, std::size_t sum) {
  const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  // ways[k][s]: probability-like weights of k of the ranks so far with sum s.
  std::vector<std::vector<double>> ways(chosen + 1, std::vector<double>(total + 1, 0.0));
  ways[0][0] = 1.0;
  for (const std::size_t rank : ranks) {
    for (std::size_t k = chosen; k-- > 0;) {
      for (std::size_t s = 0; s + rank <= total; ++s) ways[k + 1][s + rank] += ways[k][s];
    }
  }
  // The mean sum is chosen / n of the total; distances from it in whole numbers.
  const std::size_t n = ranks.size();
  const auto distance = [&](std::size_t s) {
    const auto left = static_cast<std::int64_t>(s * n);
    const auto right = static_cast<std::int64_t>(total * chosen);
    return left > right ? left - right : right - left;
  };
  const std::int64_t seen = distance(sum);
  double all = 0.0;
  double extreme = 0.0;
  for (std::size_t s = 0; s <= total; ++s) {
    all += ways[chosen][s];
    if (distance(s) >= seen) extreme += ways[chosen][s];
  }
  return extreme / all;
}

/// Lehmann 1975, Sec. 1.4: variance of the rank sum with ties, and a continuity correction.
double approximate_p(const std::vector<std::size_t>& ranks, std::size_t chosen, std::size_t sum) {
  const auto n = static_cast<double>(ranks.size());
  const auto m = static_cast<double>(chosen);
  double squares = 0.0;
  for (const std::size_t rank : ranks) {
    const double from_mean = 0.5 * static_cast<double>(rank) - 0.5 * (n + 1.0);
    squares += from_mean * from_mean;
  }
  const double variance = m * (n - m) / (n * (n - 1.0)) * squares;
  if (variance <= 0.0) return 1.0;
  const double excess = std::fabs(0.5 * static_cast<double>(sum) - 0.5 * m * (n + 1.0));
  const double z = std::max(0.0, excess - 0.5) / std::sqrt(variance);
  return std::erfc(z / std::numbers::sqrt2);
}

/// Of logarithms.
struct Moments {
  explicit Moments(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    for (const double value : values) mean += std::log(value) / n;
    for (const double value : values) {
      const double difference = std::log(value) - mean;
      variance_of_mean += difference * difference / (n - 1.0) / n;
    }
  }
  double mean = 0.0;
  double variance_of_mean = 0.0;
};

}  // namespace

double rank_sum_p(std::span<const double> a, std::span<const double> b) {
  assert(!a.empty() && !b.empty());
  const std::vector<std::size_t> ranks = doubled_ranks(a, b);
  const auto end_of_a = ranks.begin() + static_cast<std::ptrdiff_t>(a.size());
  const std::size_t sum = std::accumulate(ranks.begin(), end_of_a, std::size_t{0});
  return ranks.size() <= kMostExactRanks ? exact_p(ranks, a.size(), sum)
                                         : approximate_p(ranks, a.size(), sum);
}

double least_rank_sum_p(std::size_t a, std::size_t b) {
  double deals = 1.0;  // C(a + b, a)
  for (std::size_t i = 1; i <= a; ++i) {
    deals *= static_cast<double>(b + i) / static_cast<double>(i);
  }
  return std::min(1.0, 2.0 / deals);
}

std::size_t fewest_repetitions(double alpha) {
  std::size_t count = 1;
  while (least_rank_sum_p(count, count) > alpha) ++count;
  return count;
}

double welch_log_p(std::span<const double> a, std::span<const double> b) {
  assert(a.size() >= 2 && b.size() >= 2);
  const Moments of_a(a);
  const Moments of_b(b);
  const double difference = std::fabs(of_a.mean - of_b.mean);
  const double variance = of_a.variance_of_mean + of_b.variance_of_mean;
  if (difference == 0.0) return 1.0;
  if (variance == 0.0) return 0.0;
  const double weight_a = of_a.variance_of_mean / variance;
  const double freedom =
      1.0 / (weight_a * weight_a / static_cast<double>(a.size() - 1) +
             (1.0 - weight_a) * (1.0 - weight_a) / static_cast<double>(b.size() - 1));
  const int whole = std::max(1, static_cast<int>(freedom));
  return 1.0 - student_t_two_sided(difference / std::sqrt(variance), whole);
}

double paired_t_p(std::span<const double> differences) {
  assert(differences.size() >= 2);
  const auto n = static_cast<double>(differences.size());
  const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) / n;
  double squares = 0.0;
  for (const double difference : differences) squares += (difference - mean) * (difference - mean);
  if (mean == 0.0) return 1.0;
  const double standard_error = std::sqrt(squares / (n - 1.0) / n);
  if (standard_error == 0.0) return 0.0;
  return 1.0 - student_t_two_sided(std::fabs(mean) / standard_error,
                                   static_cast<int>(differences.size()) - 1);
}

std::vector<double> adjusted_for_false_discovery(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
  std::vector<double> adjusted(p.size());
  double least = 1.0;
  for (std::size_t rank = p.size(); rank > 0; --rank) {
    const std::size_t index = order[rank - 1];
    least = std::min(least, p[index] * static_cast<double>(p.size()) / static_cast<double>(rank));
    adjusted[index] = least;
  }
  return adjusted;
}

Estimate ratio_of_medians(std::span<const double> a, std::span<const double> b, std::uint64_t seed,
                          int resamples) {
  assert(!a.empty() && !b.empty());
  const auto [least_a, greatest_a] = std::minmax_element(a.begin(), a.end());
  const auto [least_b, greatest_b] = std::minmax_element(b.begin(), b.end());
  Estimate ratio{base::median(b) / base::median(a), *least_b / *greatest_a, *greatest_b / *least_a,
                 std::min(a.size(), b.size())};
  if (ratio.count < kFewestForMedianInterval) return ratio;
  std::mt19937_64 random(seed);
  const auto drawn_median = [&](std::span<const double> values) {
    std::vector<double> drawn(values.size());
    for (double& value : drawn) value = values[random() % values.size()];
    return base::median(drawn);
  };
  std::vector<double> ratios(static_cast<std::size_t>(resamples));
  for (double& drawn : ratios) {
    const double of_b = drawn_median(b);
    drawn = of_b / drawn_median(a);
  }
  std::sort(ratios.begin(), ratios.end());
  constexpr double kTail = 0.025;
  ratio.low = base::quantile(ratios, kTail);
  ratio.high = base::quantile(ratios, 1.0 - kTail);
  return ratio;
}

Estimate geometric_mean(std::span<const double> ratios) {
  std::vector<double> logs;
  for (const double ratio : ratios) logs.push_back(std::log(ratio));
  Estimate mean = mean_with_interval(logs);
  return {std::exp(mean.value), std::exp(mean.low), std::exp(mean.high), mean.count};
}

}  // namespace results::comparison
