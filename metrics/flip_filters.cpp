#include "metrics/flip_filters.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

namespace metrics {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// A term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a contrast sensitivity filter, x in degrees
/// (Andersson et al. 2020, Table 1).
struct SensitivityTerm {
  float a;
  float b_deg2;
};
constexpr SensitivityTerm kAchromatic{1.0F, 0.0047F};
constexpr SensitivityTerm kRedGreen{1.0F, 0.0053F};
constexpr SensitivityTerm kBlueYellowWide{34.1F, 0.04F};
constexpr SensitivityTerm kBlueYellowNarrow{13.5F, 0.025F};

/// Width of the feature filters, degrees: the distance between the peak of an edge's response and
/// its trough (Andersson et al. 2020, Sec. 4.2). Half of it is their standard deviation.
constexpr float kFeatureWidthDeg = 0.082F;

Kernel<float> sample(int radius_px, const std::function<float(float)>& function) {
  Kernel<float> kernel;
  for (int i = -radius_px; i <= radius_px; ++i) {
    kernel.weights.push_back(function(static_cast<float>(i)));
  }
  return kernel;
}

float sum_of(const Kernel<float>& kernel) {
  return std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0F);
}

void scale(Kernel<float>& kernel, float factor) {
  for (float& weight : kernel.weights) weight *= factor;
}

/// Positive weights sum to 1, negative ones to -1.
void balance(Kernel<float>& kernel) {
  float positive = 0.0F;
  float negative = 0.0F;
  for (const float weight : kernel.weights) (weight > 0.0F ? positive : negative) += weight;
  for (float& weight : kernel.weights) weight /= weight > 0.0F ? positive : -negative;
}

/// Samples of a term; `amplitude` stands for a sqrt(pi / b).
Kernel<float> sensitivity(const SensitivityTerm& term, float amplitude, int radius_px, float ppd) {
  const float pixel_deg = 1.0F / ppd;
  return sample(radius_px, [&](float i) {
    const float x_deg = i * pixel_deg;
    return amplitude * std::exp(-(kPi * kPi) * (x_deg * x_deg) / term.b_deg2);
  });
}

float amplitude_of(const SensitivityTerm& term) { return term.a * std::sqrt(kPi / term.b_deg2); }

void add_sensitivity_filters(float ppd, FlipFilters& filters) {
  // Three standard deviations of the widest Gaussian, for all channels.
  const float widest_deg = std::sqrt(kBlueYellowWide.b_deg2 / (2.0F * kPi * kPi));
  const int radius_px = static_cast<int>(std::ceil(3.0F * widest_deg * ppd));
  filters.achromatic = sensitivity(kAchromatic, amplitude_of(kAchromatic), radius_px, ppd);
  filters.red_green = sensitivity(kRedGreen, amplitude_of(kRedGreen), radius_px, ppd);
  scale(filters.achromatic, 1.0F / sum_of(filters.achromatic));
  scale(filters.red_green, 1.0F / sum_of(filters.red_green));

  // Each axis takes the root of the amplitude; both terms together sum to 1 in two dimensions.
  filters.blue_yellow_wide =
      sensitivity(kBlueYellowWide, std::sqrt(amplitude_of(kBlueYellowWide)), radius_px, ppd);
  filters.blue_yellow_narrow =
      sensitivity(kBlueYellowNarrow, std::sqrt(amplitude_of(kBlueYellowNarrow)), radius_px, ppd);
  const float factor =
      1.0F / std::hypot(sum_of(filters.blue_yellow_wide), sum_of(filters.blue_yellow_narrow));
  scale(filters.blue_yellow_wide, factor);
  scale(filters.blue_yellow_narrow, factor);
}

/// The derivatives' weights are rounded as the authors' program rounds them, on purpose: what is
/// left of their balance answers uniform areas with some 1e-8, which the square root of Sec. 4.2
/// raises to 1e-4, and every published value contains it.
void add_feature_filters(float ppd, FlipFilters& filters) {
  const float sigma_px = 0.5F * kFeatureWidthDeg * ppd;
  const int radius_px = static_cast<int>(std::ceil(3.0F * sigma_px));
  const auto gaussian = [&](float i) { return std::exp(-(i * i) / (2.0F * sigma_px * sigma_px)); };
  filters.gaussian = sample(radius_px, gaussian);
  const float sum = sum_of(filters.gaussian);
  for (float& weight : filters.gaussian.weights) weight /= sum;
  filters.edge = sample(radius_px, [&](float i) { return -i * gaussian(i); });
  filters.point = sample(
      radius_px, [&](float i) { return (i * i / (sigma_px * sigma_px) - 1.0F) * gaussian(i); });
  balance(filters.edge);
  balance(filters.point);
}

}  // namespace

int FlipFilters::largest_radius_px() const {
  return std::max(achromatic.radius(), gaussian.radius());
}

FlipFilters make_flip_filters(double pixels_per_degree) {
  assert(pixels_per_degree >= kFlipLowestPpd && pixels_per_degree <= kFlipHighestPpd);
  FlipFilters filters;
  add_sensitivity_filters(static_cast<float>(pixels_per_degree), filters);
  add_feature_filters(static_cast<float>(pixels_per_degree), filters);
  return filters;
}

}  // namespace metrics
