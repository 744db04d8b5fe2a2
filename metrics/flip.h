#pragma once

#include "metrics/metric.h"

namespace metrics {

/// FLIP, the difference that a viewer notices when flipping between two pictures, in [0, 1]:
/// between display-encoded pictures, or the largest over a range of exposures of scene-linear ones.
///
/// Sources: Andersson et al. 2020, doi:10.1145/3406183; Andersson et al. 2021,
/// doi:10.2312/egs.20211015.
MetricInfo flip_info();

}  // namespace metrics
