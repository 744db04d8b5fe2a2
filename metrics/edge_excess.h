#pragma once

#include "metrics/metric.h"

namespace metrics {

/// The larger of a pixel's steps to its right and lower neighbour, in thresholds of the pixel, of
/// those that are above one threshold in the test and not in the reference; 0 if none is.
/// @param reference, test, threshold  one channel, cd/m2, of one size; thresholds > 0
float excess_step(const Image& reference, const Image& test, const Image& threshold_cd_m2, int x,
                  int y);

/// `edge-excess`: share of the pixels with a visible step that the reference has not; ours. Bands,
/// seams, stairs and stripes are such steps, and so is visible noise.
///
/// With Y the luminance on the display, d a pixel's step to its right or lower neighbour and dL the
/// pixel's threshold of perception/threshold_map.h on the reference alone, the pixel counts if
/// |d(test)| > dL >= |d(reference)| for one of the two. dL is the threshold of a spot, TVI(L_a) x
/// `tvi_scale`: an edge holds all frequencies, so that content of one octave does not hide it.
/// `masking=joint` and `separate` take dL = TVI x CSF x masking, as in `visible-difference`.
///
/// A sharp displaced edge counts, too; a blurred one does not. 0 if there is no neighbour.
MetricInfo edge_excess_info();

}  // namespace metrics
