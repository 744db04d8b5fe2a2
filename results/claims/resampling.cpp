#include "results/claims/resampling.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "perception/base/quantile.h"
#include "results/statistics.h"

namespace results::claims {
namespace {

constexpr double kConfidence = 0.95;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// P(Z <= z) of the standard normal distribution.
double normal_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// Part of the replicates beyond either end.
double tail_of(std::size_t fewest_seeds) {
  if (fewest_seeds < 2) return 0.5 * (1.0 - kConfidence);
  const double n = static_cast<double>(fewest_seeds);
  const double t = student_t_half_width(kConfidence, static_cast<int>(fewest_seeds) - 1);
  return normal_below(-std::sqrt(n / (n - 1.0)) * t);
}

double value_at_rank(std::vector<double> values, std::size_t rank) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

/// The replicates with another value for those that are not numbers.
std::vector<double> with_nan_as(double substitute, std::vector<double> values) {
  for (double& value : values) {
    if (std::isnan(value)) value = substitute;
  }
  return values;
}

/// A number of one row; `of_counts` gives its value when groups are drawn that often.
template <class OfCounts>
Number resampled(double value, std::size_t row, Noise noise, std::size_t groups,
                 const OfCounts& of_counts) {
  Number number;
  number.value = value;
  if (groups < 2) {
    number.single_rows.insert(row);
    return number;
  }
  if (noise == Noise::seeds) number.fewest_seeds = groups;
  const std::vector<std::uint16_t> counts = draw_counts(row, noise, groups);
  number.replicates.reserve(kReplicates);
  for (std::size_t i = 0; i < kReplicates; ++i) {
    number.replicates.push_back(of_counts(std::span(counts).subspan(i * groups, groups)));
  }
  return number;
}

/// Draws of every row of a pool; none for a row of one group.
std::vector<std::vector<std::uint16_t>> draws_of(std::span<const PooledRow> rows, Noise noise) {
  std::vector<std::vector<std::uint16_t>> draws;
  for (const PooledRow& row : rows) {
    draws.push_back(row.groups < 2 ? std::vector<std::uint16_t>()
                                   : draw_counts(row.row, noise, row.groups));
  }
  return draws;
}

/// A number of a pool; `of_weights` gives its value from a weight per sample.
template <class OfWeights>
Number pooled(std::span<const PooledSample> samples, std::span<const PooledRow> rows, Noise noise,
              const OfWeights& of_weights) {
  std::vector<std::uint16_t> weights(samples.size(), 1);
  Number number;
  number.value = of_weights(weights);
  bool is_resampled = false;
  for (const PooledRow& row : rows) {
    if (row.groups < 2) {
      number.single_rows.insert(row.row);
      continue;
    }
    is_resampled = true;
    if (noise != Noise::seeds) continue;
    number.fewest_seeds =
        number.fewest_seeds == 0 ? row.groups : std::min(number.fewest_seeds, row.groups);
  }
  if (!is_resampled) return number;
  const std::vector<std::vector<std::uint16_t>> draws = draws_of(rows, noise);
  for (std::size_t i = 0; i < kReplicates; ++i) {
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const std::size_t groups = rows[samples[s].slot].groups;
      if (groups > 1) weights[s] = draws[samples[s].slot][i * groups + samples[s].group];
    }
    number.replicates.push_back(of_weights(weights));
  }
  return number;
}

}  // namespace

std::optional<Interval> interval_of(const Number& number) {
  if (number.replicates.empty()) return std::nullopt;
  const double last = static_cast<double>(number.replicates.size() - 1);
  const double tail = tail_of(number.fewest_seeds);
  const auto low = static_cast<std::size_t>(std::floor(tail * last));
  const auto high = static_cast<std::size_t>(std::ceil((1.0 - tail) * last));
  return Interval{value_at_rank(with_nan_as(-kInfinity, number.replicates), low),
                  value_at_rank(with_nan_as(kInfinity, number.replicates), high)};
}

Number combine(std::span<const Number* const> numbers,
               const std::function<double(std::span<const double>)>& function) {
  Number result;
  std::vector<double> inputs;
  bool is_resampled = false;
  for (const Number* number : numbers) {
    inputs.push_back(number->value);
    is_resampled = is_resampled || !number->replicates.empty();
    result.single_rows.insert(number->single_rows.begin(), number->single_rows.end());
    if (number->fewest_seeds == 0) continue;
    result.fewest_seeds = result.fewest_seeds == 0
                              ? number->fewest_seeds
                              : std::min(result.fewest_seeds, number->fewest_seeds);
  }
  result.value = function(inputs);
  if (!is_resampled) return result;
  result.replicates.reserve(kReplicates);
  for (std::size_t i = 0; i < kReplicates; ++i) {
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (!numbers[k]->replicates.empty()) inputs[k] = numbers[k]->replicates[i];
    }
    result.replicates.push_back(function(inputs));
  }
  return result;
}

Number combine(std::span<const Number> numbers,
               const std::function<double(std::span<const double>)>& function) {
  std::vector<const Number*> pointers;
  for (const Number& number : numbers) pointers.push_back(&number);
  return combine(pointers, function);
}

Number reduce(std::span<const Number> numbers,
              const std::function<double(std::span<const double>)>& reduction) {
  return combine(numbers, [&](std::span<const double> values) {
    const bool has_nan =
        std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
    return has_nan ? std::numeric_limits<double>::quiet_NaN() : reduction(values);
  });
}

std::vector<std::uint16_t> draw_counts(std::size_t row, Noise noise, std::size_t count) {
  assert(count > 0 && count <= std::numeric_limits<std::uint16_t>::max());
  // Steele, Lea & Flood 2014, SplitMix64; either half of a number makes one draw, whose bias is
  // below 2^-16 for any count.
  std::uint64_t state = 2 * row + (noise == Noise::seeds ? 1 : 0);
  const auto random = [&] {
    state += 0x9E3779B97F4A7C15U;
    std::uint64_t mixed = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9U;
    mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBU;
    return mixed ^ (mixed >> 31);
  };
  state = random();  // neighbouring rows start far from each other
  std::vector<std::uint16_t> counts(kReplicates * count, 0);
  for (std::size_t i = 0; i < kReplicates; ++i) {
    std::uint16_t* const drawn = counts.data() + i * count;
    for (std::size_t k = 0; k < count; k += 2) {
      const std::uint64_t number = random();
      ++drawn[((number & 0xFFFFFFFFU) * count) >> 32];
      if (k + 1 < count) ++drawn[((number >> 32) * count) >> 32];
    }
  }
  return counts;
}

Number resampled_median(std::span<const double> values, std::size_t row, Noise noise) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> sorted;
  for (const std::size_t index : order) sorted.push_back(values[index]);
  std::vector<std::uint16_t> sorted_counts(values.size());
  return resampled(base::median(values), row, noise, values.size(),
                   [&](std::span<const std::uint16_t> counts) {
                     for (std::size_t i = 0; i < order.size(); ++i) {
                       sorted_counts[i] = counts[order[i]];
                     }
                     return median_of_counts(sorted, sorted_counts);
                   });
}

Number resampled_mean(std::span<const double> values, std::size_t row, Noise noise) {
  const double count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  // Deviations from the mean: equal values have a mean of exactly that value.
  return resampled(mean, row, noise, values.size(), [&](std::span<const std::uint16_t> counts) {
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += counts[i] * (values[i] - mean);
    return mean + sum / count;
  });
}

Number pooled_quantile(std::vector<PooledSample> samples, std::span<const PooledRow> rows,
                       Noise noise, double q) {
  std::stable_sort(samples.begin(), samples.end(),
                   [](const PooledSample& a, const PooledSample& b) { return a.value < b.value; });
  // Hyndman & Fan 1996, type 7, as base::quantile, of samples that are there several times.
  return pooled(samples, rows, noise, [&](std::span<const std::uint16_t> weights) {
    const auto total = std::accumulate(weights.begin(), weights.end(), std::size_t{0});
    const double position = q * static_cast<double>(total - 1);
    const double low_rank = std::floor(position);
    std::size_t below = 0;
    std::size_t i = 0;
    while (static_cast<double>(below + weights[i]) <= low_rank) below += weights[i++];
    const double low = samples[i].value;
    const double weight = position - low_rank;
    if (weight == 0.0) return low;
    while (static_cast<double>(below + weights[i]) <= low_rank + 1.0) below += weights[i++];
    return low + weight * (samples[i].value - low);
  });
}

Number pooled_share(std::span<const PooledSample> samples, std::span<const PooledRow> rows,
                    Noise noise, const std::function<bool(double)>& condition) {
  std::vector<bool> is_met;
  for (const PooledSample& sample : samples) is_met.push_back(condition(sample.value));
  return pooled(samples, rows, noise, [&](std::span<const std::uint16_t> weights) {
    std::size_t total = 0;
    std::size_t met = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      total += weights[i];
      if (is_met[i]) met += weights[i];
    }
    return static_cast<double>(met) / static_cast<double>(total);
  });
}

}  // namespace results::claims
