#pragma once

#include "metrics/separable_filter.h"

namespace metrics {

/// The filters of FLIP, one axis each; two-dimensional ones are products of two of them.
///
/// Source: Andersson et al. 2020, FLIP: A Difference Evaluator for Alternating Images, Sec. 4.1.1
/// (contrast sensitivity) and Sec. 4.2 (features), doi:10.1145/3406183; constants and sampling as
/// in the authors' program, version 1.6.
struct FlipFilters {
  /// Contrast sensitivity of the three opponent channels. The one of the blue-yellow channel is
  /// the sum of a wide and a narrow Gaussian; each of the others is one.
  Kernel<float> achromatic;
  Kernel<float> red_green;
  Kernel<float> blue_yellow_wide;
  Kernel<float> blue_yellow_narrow;
  /// Feature detection: a Gaussian, its first derivative (edges), its second derivative (points).
  Kernel<float> gaussian;
  Kernel<float> edge;
  Kernel<float> point;

  int largest_radius_px() const;
};

/// Lowest resolution taken; below, the filters are much narrower than a pixel.
inline constexpr double kFlipLowestPpd = 5.0;
/// Highest resolution taken, to bound the filters' length.
inline constexpr double kFlipHighestPpd = 1000.0;

/// @param pixels_per_degree  in [kFlipLowestPpd, kFlipHighestPpd]
FlipFilters make_flip_filters(double pixels_per_degree);

}  // namespace metrics
