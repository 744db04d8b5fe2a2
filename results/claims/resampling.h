#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <vector>

/// Intervals of whole expressions: what is measured several times is drawn again, with replacement,
/// and the expression is evaluated anew.
///
/// Sources: Efron & Tibshirani, An Introduction to the Bootstrap, 1993; Hesterberg, What Teachers
/// Should Know About the Bootstrap, The American Statistician 69 (2015), 371-386; Steele, Lea &
/// Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014 (constants from memory).
namespace results::claims {

/// Times that everything is drawn again. 25 of them lie beyond either end of an interval (ours).
inline constexpr std::size_t kReplicates = 1000;

/// A number, and what it becomes when the samples behind it are drawn again.
struct Number {
  double value = 0.0;
  std::vector<double> replicates;     ///< kReplicates; none: nothing behind it was measured twice
  std::size_t fewest_seeds = 0;       ///< of the scores in `replicates`; 0: there are none
  std::set<std::size_t> single_rows;  ///< rows behind it that have one sample: not in `replicates`
};

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The 95 % percentile interval (Efron & Tibshirani 1993, ch. 13), by ranks, not interpolated. Of
/// scores of n seeds it is Hesterberg's expanded one (2015, Sec. 5.3, section and formula from
/// memory): tails of Phi(-sqrt(n / (n-1)) t(n-1, 0.975)), which for few seeds is about as wide as
/// Student's. A replicate that is not a number counts as beyond both ends. Nothing without
/// replicates.
std::optional<Interval> interval_of(const Number& number);

/// A function of several numbers, evaluated with the replicates of the same draw.
Number combine(std::span<const Number* const> numbers,
               const std::function<double(std::span<const double>)>& function);
Number combine(std::span<const Number> numbers,
               const std::function<double(std::span<const double>)>& function);

/// Likewise; not a number if one of the inputs is not.
Number reduce(std::span<const Number> numbers,
              const std::function<double(std::span<const double>)>& reduction);

/// What tells the noise of a row's samples; each is drawn by itself.
enum class Noise { repetitions, seeds };

/// How often each of `count` groups of samples of a row is drawn: kReplicates lists of `count`. The
/// same row, noise and count have the same draws, so quantities of a row stay paired.
std::vector<std::uint16_t> draw_counts(std::size_t row, Noise noise, std::size_t count);

/// Median, or mean, of values drawn again. @param values  one per group, at least one
Number resampled_median(std::span<const double> values, std::size_t row, Noise noise);
Number resampled_mean(std::span<const double> values, std::size_t row, Noise noise);

/// Samples of several rows; those of a group are drawn together.
struct PooledSample {
  double value = 0.0;
  std::uint32_t slot = 0;   ///< of its row in a list of rows
  std::uint32_t group = 0;  ///< within the row
};
struct PooledRow {
  std::size_t row = 0;
  std::size_t groups = 0;
};

/// Quantile of all samples, as base::quantile. @param samples  at least one
Number pooled_quantile(std::vector<PooledSample> samples, std::span<const PooledRow> rows,
                       Noise noise, double q);
/// Share of the samples that a condition holds for.
Number pooled_share(std::span<const PooledSample> samples, std::span<const PooledRow> rows,
                    Noise noise, const std::function<bool(double)>& condition);

}  // namespace results::claims
