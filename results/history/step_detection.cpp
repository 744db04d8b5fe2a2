#include "results/history/step_detection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "perception/base/quantile.h"

namespace results::history {

namespace {

constexpr std::size_t kShortestLevel = 2;

/// Keeps the sum of distances from the median of the values added so far.
class RunningMedian {
 public:
  void add(double value) {
    if (low_.empty() || value <= *low_.rbegin()) {
      low_.insert(value);
      low_sum_ += value;
    } else {
      high_.insert(value);
      high_sum_ += value;
    }
    if (low_.size() > high_.size() + 1)
      move(low_, std::prev(low_.end()), low_sum_, high_, high_sum_);
    if (high_.size() > low_.size()) move(high_, high_.begin(), high_sum_, low_, low_sum_);
  }
  double cost() const {
    const double median = *low_.rbegin();
    return median * static_cast<double>(low_.size()) - low_sum_ + high_sum_ -
           median * static_cast<double>(high_.size());
  }

 private:
  using Half = std::multiset<double>;
  static void move(Half& from, Half::iterator value, double& from_sum, Half& to, double& to_sum) {
    from_sum -= *value;
    to_sum += *value;
    to.insert(*value);
    from.erase(value);
  }
  Half low_;
  Half high_;
  double low_sum_ = 0.0;
  double high_sum_ = 0.0;
};

/// Scale b of Laplace noise: two draws differ by less than 1.1462 b half of the time, the root of
/// (1 + x / 2) exp(-x) = 1/2.
double noise_scale(std::span<const double> y) {
  constexpr double kMedianDifference = 1.1462;
  std::vector<double> differences;
  for (std::size_t i = 1; i < y.size(); ++i) differences.push_back(std::fabs(y[i] - y[i - 1]));
  return base::median(differences) / kMedianDifference;
}

/// Where levels begin, the first at 0.
std::vector<std::size_t> level_begins(std::span<const double> y, double price) {
  const std::size_t n = y.size();
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> best(n + 1, kNone);  // of the first i values
  std::vector<std::size_t> begin_of(n + 1, 0);
  best[0] = -price;
  for (std::size_t end = kShortestLevel; end <= n; ++end) {
    RunningMedian level;
    for (std::size_t begin = end; begin-- > 0;) {
      level.add(y[begin]);
      if (end - begin < kShortestLevel || best[begin] == kNone) continue;
      const double cost = best[begin] + price + level.cost();
      if (cost >= best[end]) continue;
      best[end] = cost;
      begin_of[end] = begin;
    }
  }
  std::vector<std::size_t> begins;
  for (std::size_t end = n; end > 0; end = begin_of[end]) begins.push_back(begin_of[end]);
  std::ranges::reverse(begins);
  return begins;
}

}  // namespace

std::vector<Step> find_steps(std::span<const double> values, double least_effect) {
  if (values.size() < 2 * kShortestLevel) return {};
  const bool is_positive = std::ranges::all_of(values, [](double value) { return value > 0.0; });
  std::vector<double> y(values.begin(), values.end());
  if (is_positive)
    std::ranges::transform(y, y.begin(), [](double value) { return std::log(value); });
  // Values that repeat to the bit have no noise; rounding is not a step.
  constexpr double kLeastNoise = 1e-9;
  const double b = std::max(noise_scale(y), kLeastNoise);
  const std::vector<std::size_t> begins =
      level_begins(y, 2.0 * b * std::log(static_cast<double>(y.size())));
  std::vector<Step> steps;
  std::size_t level_begin = 0;
  for (std::size_t i = 1; i < begins.size(); ++i) {
    const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : values.size();
    const double before = base::median(values.subspan(level_begin, begins[i] - level_begin));
    const double after = base::median(values.subspan(begins[i], end - begins[i]));
    const double effect =
        is_positive ? std::max(after / before, before / after) - 1.0 : std::fabs(after - before);
    if (effect < least_effect) continue;  // the level goes on
    steps.push_back({begins[i], before, after});
    level_begin = begins[i];
  }
  return steps;
}

}  // namespace results::history
