#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace perception {

/// How the least visible step in luminance grows with the luminance the eye is adapted to.
enum class ThresholdCurve {
  ferwerda_cones,  ///< Ferwerda et al. 1996, photopic
  ferwerda_rods,   ///< Ferwerda et al. 1996, scotopic
  ward,            ///< Ward Larson et al. 1997: both joined; steps of -2.7 % and -0.7 % where the
                   ///< published pieces do not meet
  ward_smooth,     ///< the same without the two steps: continuous and increasing, for solvers
  hdr_vdp2,        ///< L / S_A(L) of HDR-VDP-2: 3.3 % at 100 cd/m2
  weber            ///< 2 % of the luminance, the laxer half of the usual 1-2 %
};

std::string to_string(ThresholdCurve curve);  ///< "ferwerda_cones", ..., "weber"
/// @throws base::InputError listing the accepted names
ThresholdCurve threshold_curve_from_text(std::string_view text);
std::vector<std::string> threshold_curve_names();

/// Least visible difference of a large, long-lasting spot from its background, cd/m2.
///
/// Photopic Weber fractions are 5.6 % for the Ferwerda and Ward curves: far above what gratings
/// need (0.2 to 1 %), so that "one threshold" here is coarse.
/// @param luminance_cd_m2  of the adapting background; 0 and below stand for darkness and give the
///        limit there (0 for `hdr_vdp2` and `weber`, an absolute threshold for the others)
/// @return > 0, or 0 as said; NaN for NaN, infinity for infinity
/// Sources: in the .cpp file.
double threshold_cd_m2(ThresholdCurve curve, double luminance_cd_m2);

/// Luminance sensitivity of HDR-VDP-2, the inverse of the Weber fraction: S_A = s1 ((s2/L)^s3 +
/// 1)^-s4. @param luminance_cd_m2  as above; 0 and below give 0
double hdr_vdp2_luminance_sensitivity(double luminance_cd_m2);
/// The same with the constants of HDR-VDP-3.0.6.
double hdr_vdp3_luminance_sensitivity(double luminance_cd_m2);

}  // namespace perception
