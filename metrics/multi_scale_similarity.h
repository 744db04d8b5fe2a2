#pragma once

#include <array>
#include <span>

#include "metrics/metric.h"
#include "metrics/separable_filter.h"

/// Multi-scale structural similarity (MS-SSIM).
///
/// Source: Wang, Simoncelli, Bovik 2003, Multi-scale Structural Similarity for Image Quality
/// Assessment, Asilomar Conference on Signals, Systems and Computers,
/// doi:10.1109/ACSSC.2003.1292216 (equation and table recalled from memory, as are the steps of the
/// authors' program).
namespace metrics {

/// Exponents of the scales, finest first (the paper's psychophysical fit); their sum is 1.0001.
inline constexpr std::array<double, 5> kMsSsimWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
inline constexpr int kMsSsimScales = static_cast<int>(kMsSsimWeights.size());

/// Number of scales at which an 11 x 11 window fits into the image, 1 to 5: 5 from 176 pixels (the
/// shorter side) on, 4 from 88, 3 from 44, 2 from 22. One scale is used for what is smaller.
int fitting_scales(int width_px, int height_px);

/// What a multi-scale comparison needs besides the two planes.
struct MultiScaleOptions {
  const char* metric = "";  ///< name, for messages
  int scales = 0;           ///< 1 to 5, or 0: as many as fit
};

/// MS-SSIM of two planes of values in [0, 1] as a score.
///
/// Value: product over the scales of the mean contrast-structure term, at the coarsest of the mean
/// SSIM, each to the power of its weight; fewer than five weights are scaled up to the same sum. A
/// negative mean counts as 0. The next scale is made of means of 2 x 2 pixels, an odd last row or
/// column counted twice. Map: 1 - the same product of the terms at each pixel. Details: `scales`,
/// `negative_scales`, `scale_<i>_mean`, finest first.
/// @param mask  one channel, same size, or null; a coarse pixel takes part if one under it does
/// @throws base::InputError if more scales are asked for than fit
Score score_multi_scale(const Plane<double>& reference, const Plane<double>& test,
                        const Image* mask, const MultiScaleOptions& options);

/// The parameter `scales` of the metrics that are built on this one.
base::ParameterSpec scales_parameter();

MetricInfo ms_ssim_info();

}  // namespace metrics
