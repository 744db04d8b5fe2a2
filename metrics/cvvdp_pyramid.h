#pragma once

#include <vector>

#include "metrics/separable_filter.h"

/// The image pyramid of ColorVideoVDP: Gaussian levels of half size each and their expansion.
///
/// Source: Burt, Adelson 1983, The Laplacian Pyramid as a Compact Image Code, IEEE Trans.
/// Communications 31(4), with the kernel (0.05, 0.25, 0.4, 0.25, 0.05); borders and frequencies as
/// in the program of Mantiuk et al. 2024 (cvvdp.h), version 0.5.7.
namespace metrics {

/// Centre frequencies of the bands in cycles per degree, finest first, the base band last: one band
/// per reduction and the base band. An image with a side below 4 pixels has only that.
std::vector<double> cvvdp_band_frequencies_cpd(int width_px, int height_px,
                                               double pixels_per_degree);

/// The next level: filtered, and every second row and column kept.
///
/// Borders are mirrored with the border pixel twice. As in the authors' program, whether the number
/// of rows is odd also decides what is added to the last column; where rows and columns differ in
/// that, its weights do not add up to 1.
/// @param fine  at least 4 x 4 pixels
Plane<float> cvvdp_reduced(const Plane<float>& fine);

/// Row y of a level expanded to the size of the next finer one; borders are repeated.
/// @param out  fine_width_px values, (coarse.width_px * 2) or one less
void cvvdp_expand_row(const Plane<float>& coarse, int y, int fine_width_px, float* out);

}  // namespace metrics
