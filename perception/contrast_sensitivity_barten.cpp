// Barten 1989, "The Square Root Integral (SQRI): A New Metric to Describe the Effect of Various
//   Display Parameters on Perceived Image Quality", doi:10.1117/12.952704. The short form was
//   checked against Yee's public metric; the field size in it is recalled.
// Barten 1999, "Contrast Sensitivity of the Human Eye and Its Effects on Image Quality",
//   doi:10.1117/3.353254: the full form, checked against castleCSF's reference code, with the
//   book's constants, foveal and static.
// Barten 2003, "Formula for the Contrast Sensitivity of the Human Eye", doi:10.1117/12.537476:
//   recalled as a whole.

#include <cmath>
#include <numbers>

#include "perception/contrast_sensitivity_models.h"

namespace perception::csf_models {
namespace {

constexpr double kMinutesPerDegree = 60.0;

/// S = a f e^(-b f) sqrt(1 + c e^(b f)), with b = 0.3 (1 + 100 / L)^0.15, c = 0.06.
double short_form(double f, double luminance, double a) {
  const double b = 0.3 * std::pow(1.0 + 100.0 / luminance, 0.15);
  // e^(-bf) sqrt(1 + c e^(bf)) = sqrt(e^(-2bf) + c e^(-bf)), which cannot overflow.
  return a * f * std::sqrt(std::exp(-2.0 * b * f) + 0.06 * std::exp(-b * f));
}

// Constants of the full form, Barten 1999.
constexpr double kSignalToNoise = 3.0;            ///< k
constexpr double kBlurBase_arcmin = 0.5;          ///< sigma_0
constexpr double kBlurPerPupil_arcmin_mm = 0.08;  ///< C_ab
constexpr double kIntegration_s = 0.1;            ///< T
constexpr double kMostArea_deg = 12.0;            ///< X_max
constexpr double kMostCycles = 15.0;              ///< N_max
constexpr double kQuantumEfficiency = 0.03;       ///< eta
constexpr double kNeuralNoise_s_deg2 = 3e-8;      ///< Phi_0
constexpr double kLateralInhibition_cpd = 7.0;    ///< u_0
constexpr double kPhotons = 1.24e6;               ///< p, photons / (s deg^2 td)

/// Pupil diameter, mm: d = 5 - 3 tanh(0.4 log10(L X0^2 / 40^2)).
double pupil_mm(double luminance, double area_deg2) {
  return 5.0 - 3.0 * std::tanh(0.4 * std::log10(luminance * area_deg2 / (40.0 * 40.0)));
}

/// Retinal illuminance, troland, with the Stiles-Crawford effect:
/// E = (pi d^2 / 4) L (1 - (d / 9.7)^2 + (d / 12.4)^4).
double retinal_illuminance_td(double luminance, double pupil) {
  return std::numbers::pi * pupil * pupil / 4.0 * luminance *
         (1.0 - std::pow(pupil / 9.7, 2.0) + std::pow(pupil / 12.4, 4.0));
}

}  // namespace

/// a = 440 (1 + 0.7 / L)^-0.2.
double barten_1989(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&) {
  const double a = 440.0 * std::pow(1.0 + 0.7 / luminance_cd_m2, -0.2);
  return short_form(frequency_cpd, luminance_cd_m2, a);
}

/// a = 540 (1 + 0.7 / L)^-0.2 / (1 + 12 / (w (1 + f / 3)^2)), w the side of the field in degrees.
double barten_1989_field(double frequency_cpd, double luminance_cd_m2,
                         const StimulusConditions& conditions) {
  const double w = std::sqrt(conditions.area_deg2);
  const double size = 1.0 + 12.0 / (w * std::pow(1.0 + frequency_cpd / 3.0, 2.0));
  const double a = 540.0 * std::pow(1.0 + 0.7 / luminance_cd_m2, -0.2) / size;
  return short_form(frequency_cpd, luminance_cd_m2, a);
}

/// S = (M / k) / sqrt((2 / T) (1/X0^2 + 1/Xmax^2 + u^2/Nmax^2) (1/(eta p E) + Phi0 / (1 -
/// e^-(u/u0)^2))), M = e^(-2 pi^2 sigma^2 u^2).
double barten_1999(double frequency_cpd, double luminance_cd_m2,
                   const StimulusConditions& conditions) {
  const double u = frequency_cpd;
  if (u == 0.0) return 0.0;  // the neural noise grows without bound
  const double pupil = pupil_mm(luminance_cd_m2, conditions.area_deg2);
  const double sigma_deg =
      std::hypot(kBlurBase_arcmin, kBlurPerPupil_arcmin_mm * pupil) / kMinutesPerDegree;
  const double optics =
      std::exp(-2.0 * std::numbers::pi * std::numbers::pi * sigma_deg * sigma_deg * u * u);
  const double extent = 1.0 / conditions.area_deg2 + 1.0 / (kMostArea_deg * kMostArea_deg) +
                        u * u / (kMostCycles * kMostCycles);
  const double photon_noise =
      1.0 / (kQuantumEfficiency * kPhotons * retinal_illuminance_td(luminance_cd_m2, pupil));
  const double ratio = u / kLateralInhibition_cpd;
  const double neural_noise = kNeuralNoise_s_deg2 / -std::expm1(-ratio * ratio);
  return optics / kSignalToNoise /
         std::sqrt(2.0 / kIntegration_s * extent * (photon_noise + neural_noise));
}

/// S = 5200 e^(-0.0016 u^2 (1 + 100/L)^0.08) / sqrt((1 + 144/X0^2 + 0.64 u^2) (63/L^0.83 + 1/(1 -
/// e^(-0.02 u^2)))).
double barten_2003(double frequency_cpd, double luminance_cd_m2,
                   const StimulusConditions& conditions) {
  const double u2 = frequency_cpd * frequency_cpd;
  if (u2 == 0.0) return 0.0;
  const double optics = std::exp(-0.0016 * u2 * std::pow(1.0 + 100.0 / luminance_cd_m2, 0.08));
  const double extent = 1.0 + 144.0 / conditions.area_deg2 + 0.64 * u2;
  const double noise = 63.0 / std::pow(luminance_cd_m2, 0.83) + 1.0 / -std::expm1(-0.02 * u2);
  return 5200.0 * optics / std::sqrt(extent * noise);
}

}  // namespace perception::csf_models
