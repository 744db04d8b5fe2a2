#pragma once

#include <string>
#include <string_view>
#include <vector>

/// PU21: absolute light as numbers of equal visibility, so that metrics made for SDR pictures
/// apply.
///
/// Source: Mantiuk, Azimi 2021, PU21: A novel perceptually uniform encoding for adapting existing
/// quality metrics for HDR, Picture Coding Symposium, doi:10.1109/PCS50896.2021.9477471. The fitted
/// constants are those of the authors' program.
namespace perception {

/// What the curve was fitted to: the detection of banding or of a stimulus at the most visible
/// frequency, each with or without light scattered in the eye. The authors recommend banding_glare.
enum class PerceptualCurve { banding, banding_glare, peaks, peaks_glare };

std::string to_string(PerceptualCurve curve);  ///< "banding", "banding_glare", ...
/// @throws base::InputError listing the accepted names
PerceptualCurve perceptual_curve_from_text(std::string_view text);
std::vector<std::string> perceptual_curve_names();

/// Range of luminance the encoding is made for, cd/m2.
inline constexpr double kPuLowest_cd_m2 = 0.005;
inline constexpr double kPuHighest_cd_m2 = 1e4;

/// What metrics take as the range of values: white of an SDR display, 100 cd/m2, is near it.
inline constexpr double kPuPeak = 256.0;

/// True if the luminance lies in the range of the encoding; false for NaN.
bool is_in_pu_range(double luminance_cd_m2);

/// V = max(p7 (((p1 + p2 Y^p4) / (1 + p3 Y^p4))^p5 - p6), 0), strictly rising from 0 or more.
///
/// @param luminance_cd_m2  outside the range (`is_in_pu_range`) the nearest bound is taken, as the
///                         authors do: whoever encodes pictures counts these values; NaN stays NaN
/// @return PU value, about 256 for 100 cd/m2
double pu_encode(double luminance_cd_m2, PerceptualCurve curve);

/// The luminance of a PU value, cd/m2.
///
/// @param value  from pu_encode(kPuLowest_cd_m2) to pu_encode(kPuHighest_cd_m2)
/// @throws base::InputError outside of it, or for NaN
double pu_decode(double value, PerceptualCurve curve);

}  // namespace perception
