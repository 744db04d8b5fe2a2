#include "perception/base/quantile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace base {

double quantile(std::span<const double> values, double q) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return quantile_of_sorted(sorted, q);
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
