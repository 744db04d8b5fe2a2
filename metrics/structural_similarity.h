#pragma once

#include <cstddef>
#include <span>

#include "metrics/metric.h"
#include "metrics/separable_filter.h"

/// Structural similarity (SSIM) on display luma.
///
/// Source: Wang, Bovik, Sheikh, Simoncelli 2004, Image Quality Assessment: From Error Visibility to
/// Structural Similarity, IEEE Trans. Image Processing 13(4), doi:10.1109/TIP.2003.819861
/// (equation numbers recalled from memory).
namespace metrics {

/// Window and constants of Wang et al. 2004, Sec. III-C.
inline constexpr int kSsimWindowPx = 11;     ///< side of the Gaussian window
inline constexpr double kSsimSigmaPx = 1.5;  ///< its standard deviation
inline constexpr double kSsimK1 = 0.01;      ///< C1 = (K1 L)^2, L = peak = 1
inline constexpr double kSsimK2 = 0.03;      ///< C2 = (K2 L)^2

/// The two factors of SSIM at every pixel; their product is SSIM. The second alone is what the
/// finer scales of a multi-scale index use.
struct SimilarityMaps {
  Plane<float> luminance;           ///< (2 mx my + C1) / (mx^2 + my^2 + C1)
  Plane<float> contrast_structure;  ///< (2 sxy + C2) / (sx^2 + sy^2 + C2)
};

/// @param reference, test  luma in [0, 1], same size, at least one pixel; beyond the border the
///                         first and last values are repeated
SimilarityMaps similarity_maps(const Plane<double>& reference, const Plane<double>& test);

/// Luma 0.2126 R' + 0.7152 G' + 0.0722 B' (ITU-R BT.709) of an sRGB-encoded image.
/// @param display  channels R, G, B
Plane<double> display_luma(const Image& display);

/// Mean of a similarity map and the number of pixels it was taken over.
struct PooledSimilarity {
  double mean = 0.0;
  std::size_t pixels = 0;
};

/// Mean of a map over the pixels of the mask whose window lies inside the image, as the authors'
/// program does; if there are none (small images, masks at the border), over all of the mask.
/// @param mask  one value per pixel, 0: takes no part; empty: every pixel does
PooledSimilarity pool_similarity(const Plane<double>& map, std::span<const float> mask);

/// Luminance times contrast and structure: SSIM per pixel.
Plane<double> similarity_index(const SimilarityMaps& maps);

/// SSIM of two planes of values in [0, 1] as a score: value, detail `pooled_pixels`, map 1 - SSIM.
/// @param mask  one channel, same size, or null
Score score_similarity(const Plane<double>& reference, const Plane<double>& test,
                       const Image* mask);

MetricInfo ssim_info();

}  // namespace metrics
