#pragma once

#include "metrics/metric.h"

namespace metrics {

/// `contrast-kept`: how much of a shadow's dip is left inside a region; ours.
///
/// With Y the scene-linear luminance of the region's pixels, the surrounding level is the quantile
/// `surround` of Y, the bottom its quantile `bottom` (both interpolated between ranks), and the dip
/// is surrounding level - bottom. `kept` is the test's dip / the reference's dip, and the value is
/// |1 - kept|: 0 for the whole dip, 1 for none, more than 1 for a dip more than twice as deep.
///
/// The shadow must fill more than the share `bottom` of the region and less than 1 - `surround`.
/// Noise widens the dip: a noisy test keeps more than there is.
///
/// NaN if the reference has no dip, that is, one below 1 % of its surrounding level.
MetricInfo contrast_kept_info();

}  // namespace metrics
