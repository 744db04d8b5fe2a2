#pragma once

#include <optional>

#include "metrics/metric.h"

namespace metrics {

/// What Daly's Visible Differences Predictor can be told.
struct DalySettings {
  double luminance_cd_m2 = 30.0;  ///< of the CSF, and where small contrasts keep their size
  double area_deg2 = 1.0;         ///< i^2 of the CSF
  double distance_m = 0.5;        ///< d of the CSF
  std::optional<double> slope;    ///< s of the masking curve in every band; none: Daly's by band
  bool is_phase_uncertain = true;
  /// Sensitivity to changes coarser than the baseband, where the CSF has none; 0: not seen.
  double uniform_sensitivity = 14.0;
};

/// Amplitude nonlinearity: response to a luminance, relative to the largest, R / Rmax =
/// L / (L + 12.6 L^0.63), 0 to 1. @param luminance_cd_m2  >= 0
double daly_response(double luminance_cd_m2);

/// Contrasts about this luminance come out of `daly_response` times this, per unit of contrast:
/// L dR/dL = 0.37 R (1 - R), > 0.
double daly_response_slope(double luminance_cd_m2);

/// Slope s of threshold elevation against mask contrast.
/// @param level  1 (finest) to 5; 6 is the baseband
double daly_masking_slope(int level);

/// Probability of seeing the difference at every pixel, 0 to 1; exactly 0 everywhere for identical
/// images, and the same when they are exchanged.
///
/// @param reference, test    one channel, cd/m2, finite, >= 0, of the same size
/// @param pixels_per_degree  > 0
Image daly_detection_map(Image reference, Image test, double pixels_per_degree,
                         const DalySettings& settings);

}  // namespace metrics
