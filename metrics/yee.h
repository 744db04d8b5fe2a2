#pragma once

// Yee 2004, "A Perceptual Metric for Production Testing", doi:10.1080/10867651.2004.10504901, as
// its public code has it.

#include "metrics/metric.h"

namespace metrics {

/// `yee`: fraction of the pixels that Yee's perceptual test fails.
MetricInfo yee_info();

}  // namespace metrics
