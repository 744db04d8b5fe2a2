// Mannos, Sakrison 1974, "The Effects of a Visual Fidelity Criterion on the Encoding of Images",
//   doi:10.1109/TIT.1974.1055250.
// Daly 1993, "The Visible Differences Predictor: An Algorithm for the Assessment of Image
//   Fidelity", in Watson (ed.), Digital Images and Human Vision, MIT Press, 179-206.
// Ashraf, Mantiuk, Chapiro, Wuerger 2024, "castleCSF", doi:10.1167/jov.24.4.5: Daly's form refitted
//   (reference code).
// The forms were checked against public implementations (an HDR-VDP-1 code, castleCSF); the
// papers' equation numbers are not at hand.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "perception/contrast_sensitivity_models.h"

namespace perception::csf_models {
namespace {

/// Constants of Daly's form.
struct DalyConstants {
  double peak;             ///< P
  double oblique;          ///< ob
  double eccentricity;     ///< k, 1/deg
  double frequency_scale;  ///< epsilon
  double height_cd_m2;     ///< in A_l
  double width_cd_m2;      ///< in B_l
};

constexpr DalyConstants kDaly1993{250.0, 0.78, 0.24, 0.9, 0.7, 100.0};
/// Differs from the source: its ob, 1.44757, was fitted with degrees taken for radians and would
/// favour oblique gratings; with 1 orientation plays no part.
constexpr DalyConstants kDalyRefitted{133.9, 1.0, 0.206707, 1.39533, 1.967, 13.5589};

/// S1(rho) = ((3.23 (rho^2 i^2)^-0.3)^5 + 1)^-1/5 A_l eps rho e^(-B_l eps rho)
///           sqrt(1 + 0.06 e^(B_l eps rho)).
double daly_s1(double rho, double luminance, double area_deg2, const DalyConstants& c) {
  constexpr double kLargestExponent = 50.0;  // beyond it S1 is 0 for every purpose
  const double a = 0.801 * std::pow(1.0 + c.height_cd_m2 / luminance, -0.2);
  const double b = 0.3 * std::pow(1.0 + c.width_cd_m2 / luminance, 0.15);
  const double exponent = b * c.frequency_scale * rho;
  if (exponent > kLargestExponent) return 0.0;
  const double size = std::pow(3.23 * std::pow(rho * rho * area_deg2, -0.3), 5.0);
  return std::pow(size + 1.0, -0.2) * a * c.frequency_scale * rho * std::exp(-exponent) *
         std::sqrt(1.0 + 0.06 * std::exp(exponent));
}

/// S = P min(S1(rho / (r_a r_e r_theta)), S1(rho)).
double daly_form(double rho, double luminance, const StimulusConditions& s,
                 const DalyConstants& c) {
  if (rho == 0.0) return 0.0;
  const double theta_rad = s.orientation_deg * std::numbers::pi / 180.0;
  const double r_a = 0.856 * std::pow(s.viewing_distance_m, 0.14);
  const double r_e = 1.0 / (1.0 + c.eccentricity * s.eccentricity_deg);
  const double r_theta =
      0.5 * (1.0 - c.oblique) * std::cos(4.0 * theta_rad) + 0.5 * (1.0 + c.oblique);
  return c.peak * std::min(daly_s1(rho / (r_a * r_e * r_theta), luminance, s.area_deg2, c),
                           daly_s1(rho, luminance, s.area_deg2, c));
}

}  // namespace

/// A(f) = 2.6 (0.0192 + 0.114 f) e^-((0.114 f)^1.1).
double mannos_sakrison(double frequency_cpd, double, const StimulusConditions&) {
  const double x = 0.114 * frequency_cpd;
  return 2.6 * (0.0192 + x) * std::exp(-std::pow(x, 1.1));
}

double daly(double frequency_cpd, double luminance_cd_m2, const StimulusConditions& conditions) {
  return daly_form(frequency_cpd, luminance_cd_m2, conditions, kDaly1993);
}

double daly_refitted(double frequency_cpd, double luminance_cd_m2,
                     const StimulusConditions& conditions) {
  return daly_form(frequency_cpd, luminance_cd_m2, conditions, kDalyRefitted);
}

}  // namespace perception::csf_models
