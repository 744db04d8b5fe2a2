#pragma once

#include "metrics/metric.h"

namespace metrics {

/// Daly's Visible Differences Predictor: share of the pixels whose difference in display luminance
/// is seen with at least a given probability, by contrast sensitivity, 31 oriented channels and
/// mutual masking. The map is the probability.
///
/// Source: Daly 1993, "The Visible Differences Predictor", in Watson (ed.), Digital Images and
/// Human Vision, MIT Press; see daly_channels.cpp for what was at hand.
MetricInfo daly_vdp_info();

}  // namespace metrics
