#pragma once

// Definition: ours. Thresholds: Ramasubramanian, Pattanaik, Greenberg 1999,
// doi:10.1145/311535.311543 (perception/threshold_map.h).

#include "metrics/metric.h"

namespace metrics {

/// `flicker`: what the test changes from one frame to the next beyond what the reference changes.
///
/// Of frames R (reference) and T (test) as luminance on the display, for every pixel of frame t >=
/// 1
///     J_t = |(T_t - T_(t-1)) - (R_t - R_(t-1))| / threshold(R_(t-1), R_t),
/// the threshold that of the two reference frames' mean adaptation and common contrasts. A frame's
/// value is the mean of J_t in JND. A constant error of a still picture has no flicker, nor has a
/// test that moves as its reference does. The frame rate plays no part: a change from frame to
/// frame counts as if it lasted, which is on the safe side above 10 Hz or so.
SequenceMetricInfo flicker_info();

}  // namespace metrics
