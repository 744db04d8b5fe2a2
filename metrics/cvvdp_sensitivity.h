#pragma once

#include <array>
#include <cstddef>
#include <vector>

/// Contrast sensitivity of ColorVideoVDP to still pictures.
///
/// The model looks its sensitivity up in a table of 32 luminances by 32 spatial frequencies,
/// `csf_lut_weber_fixed_size` of the authors' program 0.5.6 (MIT licence, (c) Rafal Mantiuk and
/// others), made with castleCSF for a stimulus of radius 1.5 degrees. 11 by 15 of its nodes are
/// kept here; a bicubic spline brings the others back: in log10 units within 0.023 (0.0016 on
/// average) for the achromatic, 0.0014 and 0.0017 for the chromatic channels.
///
/// Source: Mantiuk et al. 2024 (cvvdp.h); Ashraf et al. 2024, castleCSF, Journal of Vision 24(4),
/// doi:10.1167/jov.24.4.5 (recalled from memory).
namespace metrics {

/// Opponent channels: achromatic, red-green, violet-yellow.
inline constexpr std::size_t kCvvdpChannels = 3;

/// Luminances of the table: logarithmic steps from 0.005 to 10,000 cd/m2.
inline constexpr std::size_t kCvvdpLuminances = 32;
inline constexpr double kCvvdpLowest_cd_m2 = 0.005;
inline constexpr double kCvvdpHighest_cd_m2 = 1e4;

/// log10 of the sensitivity of the three channels at one frequency, by luminance of the table.
using CvvdpSensitivityCurves = std::array<std::array<double, kCvvdpLuminances>, kCvvdpChannels>;

class CvvdpSensitivity {
 public:
  /// Rebuilds the table.
  CvvdpSensitivity();

  /// Linear in log frequency between the table's nodes; beyond 0.1 to 64 cpd as at the end.
  CvvdpSensitivityCurves at(double frequency_cpd) const;

 private:
  /// One value per luminance and frequency of the full table.
  using Table = std::vector<std::array<double, kCvvdpLuminances>>;
  std::array<Table, kCvvdpChannels> tables_;  ///< [channel][frequency][luminance]
};

/// Sensitivity between the luminances of a curve, linear in log10; beyond its ends as there.
double cvvdp_sensitivity_of(const std::array<double, kCvvdpLuminances>& curve,
                            double luminance_cd_m2);

}  // namespace metrics
