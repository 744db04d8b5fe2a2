// Ashraf, Mantiuk, Chapiro, Wuerger 2024, "castleCSF - A Contrast Sensitivity Function of Color,
//   Area, Spatiotemporal Frequency, Luminance and Eccentricity", doi:10.1167/jov.24.4.5.
// Formulas and constants as in the authors' reference code (MIT licence); the paper's equation
// numbers are not at hand. The three mechanisms alone: their union over an arbitrary colour
// direction, and time and eccentricity of the chromatic ones, are left out.

#include <algorithm>
#include <array>
#include <cmath>

#include "perception/contrast_sensitivity_models.h"

namespace perception::csf_models {
namespace {

/// One channel: peak, shape over frequency, and summation over area.
struct Channel {
  double bandwidth;  ///< bw
  double floor;      ///< 1 - a, below the peak frequency
  double area_deg2;  ///< A0
  double area_cpd;   ///< f0
};

constexpr Channel kSustained{0.000213047, 1.0 - 0.100207, 157.103, 0.702338};
constexpr Channel kTransient{2.6761, 1.0 - 0.000241177, 3.81611, 3.01389};
constexpr Channel kRedGreen{2.42104, 1.0, 2816.44, 0.0711058};
constexpr Channel kVioletYellow{2.68197, 1.0, 2.82789e7, 0.000635093};

/// p1 (1 + p2 / L)^-p3.
double saturating(double luminance, double p1, double p2, double p3) {
  return p1 * std::pow(1.0 + p2 / luminance, -p3);
}

/// The same, falling again in bright light: times 1 - (1 + p4 / L)^-p5; p5 is about 1e10.
double rising_and_falling(double luminance, const std::array<double, 5>& p) {
  return saturating(luminance, p[0], p[1], p[2]) *
         -std::expm1(-p[4] * std::log1p(p[3] / luminance));
}

/// S = S_max LP(rho) rho sqrt(A_c / (1 + A_c / A)), A_c = A0 / (1 + (rho / f0)^2);
/// LP = 10^-((log10 rho - log10 f_max)^2 / 2^bw), not below the floor for rho < f_max.
double channel_sensitivity(double rho, double area, double s_max, double f_max, const Channel& c) {
  if (rho == 0.0) return 0.0;
  const double distance = std::log10(rho / f_max);
  double parabola = std::pow(10.0, -distance * distance / std::exp2(c.bandwidth));
  if (rho < f_max) parabola = std::max(parabola, c.floor);
  const double ratio = rho / c.area_cpd;
  const double critical_area = c.area_deg2 / (1.0 + ratio * ratio);
  return s_max * parabola * rho * std::sqrt(critical_area / (1.0 + critical_area / area));
}

double sustained(double rho, double luminance, double area) {
  const double s_max =
      rising_and_falling(luminance, {56.4947, 7.54726, 0.144532, 5.58341e-7, 9.66862e9});
  const double f_max = saturating(luminance, 1.78119, 91.5718, 0.256682);
  return channel_sensitivity(rho, area, s_max, f_max, kSustained);
}

double transient(double rho, double luminance, double area) {
  const double s_max = 2748.09 * std::pow(luminance, 0.193434);
  return channel_sensitivity(rho, area, s_max, 0.000316696, kTransient);
}

double sustained_response(double omega_hz) {
  return std::exp(-std::pow(omega_hz, 1.3314) / 10.5795);
}

/// In dim light its best frequency has no meaning below 0: the channel is then silent.
double transient_response(double omega_hz, double luminance) {
  const double best_hz = 2.41482 * std::log10(luminance) + 4.7036;
  if (best_hz < 0.0) return 0.0;
  const double distance = std::pow(omega_hz, 0.1898) - std::pow(best_hz, 0.1898);
  return std::exp(-distance * distance / 0.0844836);
}

/// 10^-((e_d + rho e_f) ecc).
double eccentricity_factor(double rho, const StimulusConditions& s) {
  const bool is_temporal = s.field == VisualField::temporal;
  const double e_d = is_temporal ? 0.0239853 : 0.0400662;
  const double e_f = is_temporal ? 0.0189038 : 0.00813619;
  return std::pow(10.0, -(e_d + rho * e_f) * s.eccentricity_deg);
}

}  // namespace

double castle_achromatic(double frequency_cpd, double luminance_cd_m2,
                         const StimulusConditions& s) {
  const double omega = s.temporal_frequency_hz;
  return (sustained_response(omega) * sustained(frequency_cpd, luminance_cd_m2, s.area_deg2) +
          transient_response(omega, luminance_cd_m2) *
              transient(frequency_cpd, luminance_cd_m2, s.area_deg2)) *
         eccentricity_factor(frequency_cpd, s);
}

double castle_red_green(double frequency_cpd, double luminance_cd_m2, const StimulusConditions& s) {
  const double s_max = saturating(luminance_cd_m2, 681.434, 38.0038, 0.480386);
  return channel_sensitivity(frequency_cpd, s.area_deg2, s_max, 0.0178364, kRedGreen);
}

double castle_violet_yellow(double frequency_cpd, double luminance_cd_m2,
                            const StimulusConditions& s) {
  const double s_max = saturating(luminance_cd_m2, 166.683, 62.8974, 0.41193);
  return channel_sensitivity(frequency_cpd, s.area_deg2, s_max, 0.00425753, kVioletYellow);
}

}  // namespace perception::csf_models
