#pragma once

// Ramasubramanian, Pattanaik, Greenberg 1999, "A Perceptually Based Physical Error Metric for
// Realistic Image Synthesis", doi:10.1145/311535.311543; see visible_bands.h for what is ours.

#include "metrics/metric.h"

namespace metrics {

/// `visible-difference`: fraction of the pixels whose difference is above its threshold.
MetricInfo visible_difference_info();

}  // namespace metrics
