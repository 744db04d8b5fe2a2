#include "perception/base/quantile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace base {

double quantile(std::span<const double> values, double q) {
  assert(!values.empty() && q >= 0.0 && q <= 1.0);
  // Only two of the sorted values are needed.
  std::vector<double> ordered(values.begin(), values.end());
  const double position = q * static_cast<double>(ordered.size() - 1);
  const auto place = static_cast<std::ptrdiff_t>(std::floor(position));
  std::nth_element(ordered.begin(), ordered.begin() + place, ordered.end());
  const double low = ordered[static_cast<std::size_t>(place)];
  const auto above = ordered.begin() + place + 1;
  const double high = above == ordered.end() ? low : *std::min_element(above, ordered.end());
  return low + (position - static_cast<double>(place)) * (high - low);
}

double quantile_of_sorted(std::span<const double> sorted, double q) {
  assert(!sorted.empty() && q >= 0.0 && q <= 1.0);
  const double position = q * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(std::floor(position));
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  const double weight = position - static_cast<double>(low);
  return sorted[low] + weight * (sorted[high] - sorted[low]);
}

double median(std::span<const double> values) { return quantile(values, 0.5); }

}  // namespace base
