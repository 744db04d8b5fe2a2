#pragma once

#include "metrics/metric.h"

namespace metrics {

/// `threshold-ratio`: how far the thresholds that an image gives its viewer are from those that the
/// reference gives; ours.
///
/// Each image has its own map dL_T = TVI(L_a) x F of perception/threshold_map.h under the viewing
/// conditions, as a renderer has that is steered by one of its own pictures. A pixel's ratio is
/// r = dL_T(test) / dL_T(reference): above 1 the test hides what shows in the reference, below 1 it
/// asks for work that nobody sees. The value is the median of |log2 r|, in octaves: 0 for the same
/// thresholds, 1 if half of the pixels are off by twice or more. The details keep the direction:
/// `ratio` is the median of r, exactly 1 for identical images.
///
/// The scale of TVI that is part of a profile cancels; CSF and masking do not.
/// Source of the question: Scheel et al. 2002, Sec. 5.2.1, whose preview lacks a shadow's
/// frequencies.
MetricInfo threshold_ratio_info();

}  // namespace metrics
