// Mantiuk, Kim, Rempel, Heidrich 2011, "HDR-VDP-2: A Calibrated Visual Metric for Visibility and
//   Quality Predictions in All Luminance Conditions", doi:10.1145/1964921.1964935; constants of
//   the reference code 2.2.0.
// Mantiuk, Hammou, Hanji 2023, "HDR-VDP-3", arXiv:2304.13625; constants of the option file 3.0.6.
// CSF = nCSF MTF S_A. The equation numbers of the papers are not at hand. That version 3 keeps the
// optics (MTF) of version 2 is taken from its defaults.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "perception/contrast_sensitivity_models.h"
#include "perception/threshold_vs_intensity.h"

namespace perception::csf_models {
namespace {

/// The parameters of the neural part at one luminance.
struct NeuralRow {
  double luminance_cd_m2;
  std::array<double, 4> p;
};

constexpr std::array<NeuralRow, 6> kVersion2{{
    {0.002, {0.991265, 3.74038, 0.50722, 4.46044}},
    {0.02, {0.800889, 3.54104, 0.682505, 4.94958}},
    {0.2, {0.476505, 4.37453, 0.750315, 5.28678}},
    {2.0, {0.405782, 4.40602, 0.935314, 5.61425}},
    {20.0, {0.334278, 3.79542, 1.07327, 6.4635}},
    {150.0, {0.394533, 2.7755, 1.16577, 7.45665}},
}};
constexpr std::array<NeuralRow, 7> kVersion3{{
    {0.0002, {1.26181, 4.27832, 0.361902, 3.11914}},
    {0.002, {0.893585, 4.27832, 0.361902, 2.18938}},
    {0.02, {0.84864, 3.57253, 0.530355, 3.12486}},
    {0.2, {0.699243, 3.94545, 0.68608, 4.41846}},
    {2.0, {0.530826, 4.25337, 0.866916, 4.65117}},
    {20.0, {0.459297, 3.78765, 0.981028, 4.33546}},
    {150.0, {0.312626, 4.15264, 0.952367, 3.22389}},
}};

/// The parameters, linear in log10 L between the rows and constant beyond them.
std::array<double, 4> parameters_at(std::span<const NeuralRow> rows, double luminance) {
  if (luminance <= rows.front().luminance_cd_m2) return rows.front().p;
  if (luminance >= rows.back().luminance_cd_m2) return rows.back().p;
  std::size_t i = 0;
  while (rows[i + 1].luminance_cd_m2 < luminance) ++i;
  const double low = std::log10(rows[i].luminance_cd_m2);
  const double high = std::log10(rows[i + 1].luminance_cd_m2);
  const double t = (std::log10(luminance) - low) / (high - low);
  std::array<double, 4> p{};
  for (std::size_t k = 0; k < p.size(); ++k) {
    p[k] = rows[i].p[k] + t * (rows[i + 1].p[k] - rows[i].p[k]);
  }
  return p;
}

/// nCSF = p4 / sqrt((1 + (p1 rho)^p2) / (1 - e^-(rho / 7)^2)^p3).
double neural(std::span<const NeuralRow> rows, double rho, double luminance) {
  const std::array<double, 4> p = parameters_at(rows, luminance);
  const double low_pass = 1.0 + std::pow(p[0] * rho, p[1]);
  const double high_pass = std::pow(-std::expm1(-(rho / 7.0) * (rho / 7.0)), p[2]);
  return p[3] * std::sqrt(high_pass / low_pass);
}

/// MTF = sum of a_k e^(-b_k rho).
double optics(double rho) {
  constexpr std::array<double, 4> kWeight{0.997273700 * 0.426, 0.997273700 * 0.574,
                                          0.002726300 * 0.061466549, 0.002726300 * 0.938533451};
  constexpr std::array<double, 4> kDecay_deg{0.028, 0.37, 37.0, 360.0};
  double sum = 0.0;
  for (std::size_t k = 0; k < kWeight.size(); ++k) {
    sum += kWeight[k] * std::exp(-kDecay_deg[k] * rho);
  }
  return sum;
}

}  // namespace

double hdr_vdp2(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&) {
  return neural(kVersion2, frequency_cpd, luminance_cd_m2) * optics(frequency_cpd) *
         hdr_vdp2_luminance_sensitivity(luminance_cd_m2);
}

double hdr_vdp3(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&) {
  return neural(kVersion3, frequency_cpd, luminance_cd_m2) * optics(frequency_cpd) *
         hdr_vdp3_luminance_sensitivity(luminance_cd_m2);
}

}  // namespace perception::csf_models
