// Daly 1993, "The Visible Differences Predictor: An Algorithm for the Assessment of Image
//   Fidelity", in Watson (ed.), Digital Images and Human Vision, MIT Press: the cortex transform
//   after Watson 1987, "The Cortex Transform".
// Mesa, dom and baseband were checked against a public implementation of the predictor; the fan is
// recalled. Equation numbers are not at hand.

#include "perception/cortex_transform.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <opencv2/core.hpp>

#include "perception/base/parallel.h"
#include "perception/opencv_view.h"

namespace perception {
namespace {

constexpr std::size_t kGrainValues = 1 << 14;
constexpr double kFanWidth_deg = 180.0 / CortexTransform::kOrientations;

/// Half-amplitude frequency of mesa k: 1, 1/2, 1/4, ... cycles per pixel.
double mesa_corner(int k) { return std::exp2(-k); }

/// tw = (2/3) rho.
double transition_width(int k) { return 2.0 / 3.0 * mesa_corner(k); }

/// 1 inside, 0 outside, half a cosine over the transition.
double mesa(int k, double rho) {
  const double width = transition_width(k);
  const double t = (rho - mesa_corner(k)) / width + 0.5;
  if (t <= 0.0) return 1.0;
  if (t >= 1.0) return 0.0;
  return 0.5 * (1.0 + std::cos(std::numbers::pi * t));
}

/// Frequency of an FFT bin, cycles per pixel, -0.5 to 0.5.
double bin_cycles_px(int i, int count) {
  return static_cast<double>(i <= count / 2 ? i : i - count) / count;
}

/// Room for mirrored pixels: two periods of the coarsest level.
constexpr int kMargin_px = 64;

}  // namespace

double orientation_difference_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 180.0));
}

double CortexTransform::centre_cycles_px(int level) {
  assert(level >= 1 && level <= kLevels);
  // Between the transitions of mesa k - 1 and mesa k lies the single frequency (4/3) rho_k.
  return std::min(0.5, 4.0 / 3.0 * mesa_corner(level));
}

double CortexTransform::centre_deg(int orientation) {
  assert(orientation >= 0 && orientation < kOrientations);
  return orientation * kFanWidth_deg - 90.0;
}

/// exp(-rho^2 / (2 sigma^2)), sigma = (rho_5 + tw_5 / 2) / 3.
double CortexTransform::base(double cycles_px) {
  const double end = mesa_corner(kLevels) + 0.5 * transition_width(kLevels);
  if (cycles_px >= end) return 0.0;
  const double ratio = 3.0 * cycles_px / end;
  return std::exp(-0.5 * ratio * ratio);
}

double CortexTransform::dom(int level, double cycles_px) {
  assert(level >= 1 && level <= kLevels);
  const double inner = level == kLevels ? base(cycles_px) : mesa(level, cycles_px);
  return mesa(level - 1, cycles_px) - inner;
}

/// (1 + cos(pi |theta - theta_c| / tw)) / 2 within tw = 180 / 6 degrees.
double CortexTransform::fan(int orientation, double angle_deg) {
  const double distance = orientation_difference_deg(angle_deg, centre_deg(orientation));
  if (distance >= kFanWidth_deg) return 0.0;
  return 0.5 * (1.0 + std::cos(std::numbers::pi * distance / kFanWidth_deg));
}

CortexTransform::CortexTransform(const Image& image)
    : width_px_(image.width_px),
      height_px_(image.height_px),
      padded_width_px_(cv::getOptimalDFTSize(image.width_px + kMargin_px)),
      padded_height_px_(cv::getOptimalDFTSize(image.height_px + kMargin_px)) {
  assert(image.channel_count() == 1);
  cv::Mat padded;
  cv::copyMakeBorder(opencv_view(image), padded, 0, padded_height_px_ - height_px_, 0,
                     padded_width_px_ - width_px_, cv::BORDER_REFLECT);
  spectrum_.resize(static_cast<std::size_t>(padded_width_px_) *
                   static_cast<std::size_t>(padded_height_px_));
  cv::Mat spectrum(padded_height_px_, padded_width_px_, CV_32FC2, spectrum_.data());
  cv::dft(padded, spectrum, cv::DFT_COMPLEX_OUTPUT);
  polar_.resize(spectrum_.size());
  const auto width = static_cast<std::size_t>(padded_width_px_);
  base::parallel_for(polar_.size(), kGrainValues, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      const double fx = bin_cycles_px(static_cast<int>(i % width), padded_width_px_);
      const double fy = bin_cycles_px(static_cast<int>(i / width), padded_height_px_);
      polar_[i] = {static_cast<float>(std::hypot(fx, fy)),
                   static_cast<float>(std::atan2(fy, fx) * 180.0 / std::numbers::pi)};
    }
  });
}

CortexTransform::~CortexTransform() = default;

template <class Response>
Image CortexTransform::filtered(const Response& response) const {
  std::vector<std::complex<float>> values(spectrum_.size());
  base::parallel_for(values.size(), kGrainValues, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      const auto cycles_px = static_cast<double>(polar_[i].cycles_px);
      const auto angle_deg = static_cast<double>(polar_[i].angle_deg);
      values[i] = spectrum_[i] * static_cast<float>(response(cycles_px, angle_deg));
    }
  });
  const cv::Mat product(padded_height_px_, padded_width_px_, CV_32FC2, values.data());
  cv::Mat padded;
  cv::dft(product, padded, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  Image image = make_gray_image(width_px_, height_px_, "Y", Encoding::luminance_cd_m2);
  cv::Mat view = opencv_view(image);
  padded(cv::Rect(0, 0, width_px_, height_px_)).copyTo(view);
  return image;
}

Image CortexTransform::channel(int level, int orientation) const {
  // Beyond these the dom is 0, for most of the spectrum.
  const double low = level == kLevels ? 0.0 : mesa_corner(level) - 0.5 * transition_width(level);
  const double high = mesa_corner(level - 1) + 0.5 * transition_width(level - 1);
  return filtered([=](double cycles_px, double angle_deg) {
    if (cycles_px < low || cycles_px > high) return 0.0;
    const double share = fan(orientation, angle_deg);
    return share > 0.0 ? share * dom(level, cycles_px) : 0.0;
  });
}

Image CortexTransform::baseband() const {
  return filtered([](double cycles_px, double) { return base(cycles_px); });
}

}  // namespace perception
