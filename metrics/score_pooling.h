#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "metrics/metric.h"

namespace metrics {

/// True if the pixel takes part in the pooled value. @param mask  null: every pixel does
inline bool takes_part(const Image* mask, std::size_t pixel) {
  return mask == nullptr || mask->pixels[pixel] != 0.0F;
}

/// The values of a mask, one per pixel; empty if there is none.
inline std::span<const float> mask_values(const Image* mask) {
  return mask == nullptr ? std::span<const float>() : std::span<const float>(mask->pixels);
}

/// Number of pixels that take part.
std::size_t pooled_pixel_count(const Image& image, const Image* mask);

/// Sum of row_sum(y) over all rows, in parallel but added in the order of y: the same bytes for
/// every number of threads.
double sum_over_rows(int height_px, const std::function<double(int y)>& row_sum);

/// Mean of a one-channel map over the pixels that take part.
double masked_mean(const Image& map, const Image* mask);

/// Share of the pixels that take part whose value of a one-channel map is above a limit.
double masked_share_above(const Image& map, const Image* mask, float limit);

/// The smallest value of a one-channel map that at least a share of its pixels does not exceed.
/// @param share  in (0, 1]; 0.95 is the 95th percentile by nearest rank
double masked_quantile(const Image& map, const Image* mask, double share);

/// Mean of what is left after dropping the largest values.
///
/// @param errors  at least one; their order is changed
/// @param trim    fraction of the values to drop, in [0, 1); floor(trim * count) are dropped
double trimmed_mean(std::vector<float>& errors, double trim);

/// Extremes of a map and the first position of the largest value in reading order.
struct MapExtremes {
  double minimum = 0.0;
  double maximum = 0.0;
  int max_x_px = 0;
  int max_y_px = 0;
};
MapExtremes map_extremes(const Image& map, const Image* mask);

/// Quantiles of a map in [0, 1] in which every pixel counts as much as its own value.
struct WeightedQuartiles {
  double first = 0.0;
  double median = 0.0;
  double third = 0.0;
};

/// The value below which the pixels hold a quarter, half and three quarters of the map's sum,
/// exact to 1 / 4096 (linear inside a bucket of that width); all 0 if the sum is 0.
WeightedQuartiles weighted_quartiles(const Image& map, const Image* mask);

}  // namespace metrics
