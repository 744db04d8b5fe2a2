#pragma once

#include "metrics/metric.h"

namespace metrics {

/// `penumbra-width`: how far the width of a shadow's border is from the reference's; ours.
///
/// The width is that of the transition from 10 to 90 % of the step between the levels at the ends
/// of a line, in pixels along the line: see `find_transition` and `line_profile` in line_profile.h.
/// Each image has its own levels, so that a shadow that is too light may still be as soft. The line
/// must reach from light to shadow, with the transition inside the middle eight tenths of its
/// length. A sharp border between two columns measures 0.8 px, a linear ramp 0.8 of its length.
///
/// The value is |log2(width of the test / width of the reference)|: 0 for the same width, 1 for
/// twice or half of it. NaN if either image has no transition there (levels that differ by less
/// than 1 %): there is no width to compare. The details tell which: its width is NaN.
MetricInfo penumbra_width_info();

}  // namespace metrics
