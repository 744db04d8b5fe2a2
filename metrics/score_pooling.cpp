#include "metrics/score_pooling.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "metrics/separable_filter.h"

namespace metrics {

std::size_t pooled_pixel_count(const Image& image, const Image* mask) {
  if (mask == nullptr) return image.pixel_count();
  return static_cast<std::size_t>(
      std::count_if(mask->pixels.begin(), mask->pixels.end(), [](float m) { return m != 0.0F; }));
}

double sum_over_rows(int height_px, const std::function<double(int y)>& row_sum) {
  std::vector<double> sums(static_cast<std::size_t>(height_px));
  for_each_row(height_px, [&](int y) { sums[static_cast<std::size_t>(y)] = row_sum(y); });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double masked_mean(const Image& map, const Image* mask) {
  const auto row_sum = [&](int y) {
    const std::size_t begin = map.offset(0, y);
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + static_cast<std::size_t>(map.width_px); ++i) {
      if (takes_part(mask, i)) sum += static_cast<double>(map.pixels[i]);
    }
    return sum;
  };
  return sum_over_rows(map.height_px, row_sum) / static_cast<double>(pooled_pixel_count(map, mask));
}

double masked_share_above(const Image& map, const Image* mask, float limit) {
  const double above = sum_over_rows(map.height_px, [&](int y) {
    const std::size_t begin = map.offset(0, y);
    double row = 0.0;
    for (std::size_t i = begin; i < begin + static_cast<std::size_t>(map.width_px); ++i) {
      if (takes_part(mask, i) && map.pixels[i] > limit) row += 1.0;
    }
    return row;
  });
  return above / static_cast<double>(pooled_pixel_count(map, mask));
}

double masked_quantile(const Image& map, const Image* mask, double share) {
  assert(share > 0.0 && share <= 1.0);
  std::vector<float> values;
  values.reserve(map.pixels.size());
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    if (takes_part(mask, i)) values.push_back(map.pixels[i]);
  }
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto position = values.begin() + std::max<std::ptrdiff_t>(rank - 1, 0);
  std::nth_element(values.begin(), position, values.end());
  return static_cast<double>(*position);
}

double trimmed_mean(std::vector<float>& errors, double trim) {
  assert(!errors.empty() && trim >= 0.0 && trim < 1.0);
  const auto dropped =
      static_cast<std::size_t>(std::floor(trim * static_cast<double>(errors.size())));
  const auto kept = static_cast<std::ptrdiff_t>(errors.size() - dropped);
  if (dropped > 0) std::nth_element(errors.begin(), errors.begin() + kept, errors.end());
  return std::accumulate(errors.begin(), errors.begin() + kept, 0.0) / static_cast<double>(kept);
}

MapExtremes map_extremes(const Image& map, const Image* mask) {
  float smallest = std::numeric_limits<float>::infinity();
  float largest = -std::numeric_limits<float>::infinity();
  std::size_t position = 0;
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    if (!takes_part(mask, i)) continue;
    smallest = std::min(smallest, map.pixels[i]);
    if (map.pixels[i] > largest) {
      largest = map.pixels[i];
      position = i;
    }
  }
  const auto width = static_cast<std::size_t>(map.width_px);
  return {static_cast<double>(smallest), static_cast<double>(largest),
          static_cast<int>(position % width), static_cast<int>(position / width)};
}

WeightedQuartiles weighted_quartiles(const Image& map, const Image* mask) {
  constexpr int kBuckets = 4096;
  std::vector<double> weights(kBuckets, 0.0);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    if (!takes_part(mask, i)) continue;
    const float value = std::clamp(map.pixels[i], 0.0F, 1.0F);
    const int bucket = std::min(static_cast<int>(value * kBuckets), kBuckets - 1);
    weights[static_cast<std::size_t>(bucket)] += static_cast<double>(value);
  }
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (total == 0.0) return {};

  const auto quantile = [&](double fraction) {
    double below = 0.0;
    std::size_t bucket = 0;
    while (bucket + 1 < kBuckets && below + weights[bucket] < fraction * total) {
      below += weights[bucket++];
    }
    const double inside = (fraction * total - below) / weights[bucket];
    return (static_cast<double>(bucket) + inside) / kBuckets;
  };
  return {quantile(0.25), quantile(0.5), quantile(0.75)};
}

}  // namespace metrics
