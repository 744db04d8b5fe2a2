#pragma once

#include <array>

#include "metrics/cvvdp_sensitivity.h"
#include "metrics/separable_filter.h"

/// Visible differences in one band of ColorVideoVDP (cvvdp.h): contrast, sensitivity, masking.
namespace metrics {

/// Achromatic, red-green, violet-yellow: a level of the pyramid, or what is computed from it.
using CvvdpChannelPlanes = std::array<Plane<float>, kCvvdpChannels>;

/// A level of both pictures' pyramids.
struct CvvdpLevel {
  CvvdpChannelPlanes reference;
  CvvdpChannelPlanes test;
};

/// The offset of cvvdp_power.
inline constexpr double kCvvdpPowerOffset = 1e-5;

/// (x + 1e-5)^p - 1e-5^p, the power function everywhere in the model (its authors need a gradient
/// at 0). @param x  >= 0
double cvvdp_power(double x, double p);

/// Differences of the band between a level and the next coarser one, in units of visibility.
///
/// Weber contrast: the layer over the coarser level's achromatic value (each picture by its own, at
/// least 0.01 cd/m2), times `gain`. Sensitivity at the reference's. Mutual masking by the smaller
/// of the two contrasts nearby, also across channels; soft clamp.
/// @param curves  of this band's frequency
/// @param gain    1 for the finest band, 2 for others
CvvdpChannelPlanes cvvdp_band_difference(const CvvdpLevel& fine, const CvvdpLevel& coarse,
                                         const CvvdpSensitivityCurves& curves, double gain);

/// Differences of the last level, whose contrast is taken over its picture's mean; not masked.
CvvdpChannelPlanes cvvdp_base_difference(const CvvdpLevel& last,
                                         const CvvdpSensitivityCurves& curves);

}  // namespace metrics
