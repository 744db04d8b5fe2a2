#include "results/history/step_detection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "perception/base/quantile.h"

namespace results::history {

namespace {

constexpr std::size_t kShortestLevel = 2;

/// Sums of distances from their median of the values y[begin], ..., y[end - 1] for one begin, every
/// end from the last one down. Taking a value out moves the median by one place in the sorted order
/// at most, so each sum costs a few additions.
class LevelCosts {
 public:
  explicit LevelCosts(std::span<const double> y)
      : y_(y), order_(y.size()), all_previous_(y.size() + 2), all_next_(y.size() + 2) {
    std::iota(order_.begin(), order_.end(), Place{0});
    std::ranges::stable_sort(order_, {}, [&](Place i) { return y_[i]; });
    rank_.resize(y.size());
    sorted_.resize(y.size() + 1);
    // Places 1 to n hold the sorted values; 0 and n + 1 are the ends of the list.
    for (Place place = 0; place < order_.size(); ++place) {
      rank_[order_[place]] = place + 1;
      sorted_[place + 1] = y_[order_[place]];
    }
    for (Place place = 0; place < all_next_.size(); ++place) {
      all_next_[place] = place + 1;
      all_previous_[place] = place == 0 ? 0 : place - 1;
    }
  }

  /// Calls use(end, cost) for end = n, n - 1, ..., begin + kShortestLevel.
  /// @param begin  one more with every call, from 0 on
  template <class Use>
  void for_each_end(std::size_t begin, const Use& use) {
    if (begin > 0) unlink(rank_[begin - 1], all_previous_, all_next_);
    previous_ = all_previous_;
    next_ = all_next_;
    start(begin);
    for (std::size_t end = y_.size(); end >= begin + kShortestLevel; --end) {
      use(end, cost(end - begin));
      take_out(rank_[end - 1], end - begin);
    }
  }

 private:
  using Place = std::uint32_t;  ///< lists are copied often: small ones

  static void unlink(Place place, std::vector<Place>& previous, std::vector<Place>& next) {
    next[previous[place]] = next[place];
    previous[next[place]] = previous[place];
  }

  double value(Place place) const { return sorted_[place]; }

  void start(std::size_t begin) {
    const std::size_t count = y_.size() - begin;
    const std::size_t low_count = (count + 1) / 2;
    low_sum_ = 0.0;
    high_sum_ = 0.0;
    Place place = 0;
    for (std::size_t i = 0; i < count; ++i) {
      place = next_[place];
      (i < low_count ? low_sum_ : high_sum_) += value(place);
      if (i + 1 == low_count) median_ = place;
    }
  }

  double cost(std::size_t count) const {
    const std::size_t low_count = (count + 1) / 2;
    const double excess = static_cast<double>(low_count) - static_cast<double>(count - low_count);
    return value(median_) * excess - low_sum_ + high_sum_;
  }

  /// @param count  of values, the one at `place` included; the lower half is never the smaller one
  void take_out(Place place, std::size_t count) {
    const bool is_low = place <= median_;
    (is_low ? low_sum_ : high_sum_) -= value(place);
    if (count % 2 == 0 && is_low) {
      median_ = next_[median_];
      low_sum_ += value(median_);
      high_sum_ -= value(median_);
    } else if (count % 2 == 1 && !is_low) {
      low_sum_ -= value(median_);
      high_sum_ += value(median_);
      median_ = previous_[median_];
    } else if (place == median_) {
      median_ = previous_[median_];
    }
    unlink(place, previous_, next_);
  }

  std::span<const double> y_;
  std::vector<Place> order_;    ///< indices of values by size
  std::vector<double> sorted_;  ///< values by place
  std::vector<Place> rank_;     ///< places of values by index
  std::vector<Place> all_previous_;
  std::vector<Place> all_next_;  ///< list of the values from `begin` on
  std::vector<Place> previous_;
  std::vector<Place> next_;  ///< the same without those from `end` on
  Place median_ = 0;         ///< place of the lower median
  double low_sum_ = 0.0;     ///< of the values up to the median
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
  LevelCosts costs(y);
  for (std::size_t begin = 0; begin + kShortestLevel <= n; ++begin) {
    costs.for_each_end(begin, [&](std::size_t end, double level_cost) {
      const double cost = best[begin] + price + level_cost;
      if (cost > best[end]) return;  // of equal ones the shortest last level
      best[end] = cost;
      begin_of[end] = begin;
    });
  }
  std::vector<std::size_t> begins;
  for (std::size_t end = n; end > 0; end = begin_of[end]) begins.push_back(begin_of[end]);
  std::ranges::reverse(begins);
  return begins;
}

/// Median ends of the intervals of a level.
ValueInterval typical_interval(std::span<const ValueInterval> level) {
  std::vector<double> lows;
  std::vector<double> highs;
  for (const ValueInterval& one : level) {
    lows.push_back(one.low);
    highs.push_back(one.high);
  }
  return {base::median(lows), base::median(highs)};
}

bool are_apart(std::span<const ValueInterval> before, std::span<const ValueInterval> after) {
  if (before.empty() || after.empty()) return true;  // nothing is known of them
  const ValueInterval a = typical_interval(before);
  const ValueInterval b = typical_interval(after);
  return a.high < b.low || b.high < a.low;
}

}  // namespace

std::vector<Step> find_steps(std::span<const double> values, double least_effect,
                             std::span<const ValueInterval> intervals) {
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
    const auto part = [&](std::size_t first, std::size_t last) {
      return intervals.empty() ? intervals : intervals.subspan(first, last - first);
    };
    const bool is_step =
        effect >= least_effect && are_apart(part(level_begin, begins[i]), part(begins[i], end));
    if (!is_step) continue;  // the level goes on
    steps.push_back({begins[i], before, after});
    level_begin = begins[i];
  }
  return steps;
}

}  // namespace results::history
