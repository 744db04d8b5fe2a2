// Watson, Ahumada 2005, "A standard model for foveal detection of spatial contrast", Journal of
// Vision 5(9):717-740, doi:10.1167/5.9.6: CSF, aperture, Minkowski summation.
// Differs from the paper: the CSF is any of ours, at the field's luminance; the oblique effect is
// the CSF's own, where it has one; the gain is set by one Gabor patch instead of a fit.

#include "perception/pattern_observer.h"

#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include <opencv2/core.hpp>

#include "perception/base/parallel.h"
#include "perception/contrast_sensitivity.h"

namespace perception {
namespace {

constexpr std::size_t kGrainRows = 16;

/// The patch whose threshold is the CSF's own: ModelFest's fourth.
GaborPatch anchor_patch() { return {.frequency_cpd = 4.0, .orientation_deg = 90.0}; }

StimulusConditions conditions_of(const GaborPatch& patch, double eccentricity_deg) {
  StimulusConditions conditions;
  conditions.area_deg2 = std::numbers::pi * patch.sigma_along_deg * patch.sigma_across_deg;
  conditions.orientation_deg = patch.orientation_deg;
  conditions.eccentricity_deg = eccentricity_deg;
  return conditions;
}

/// The pattern at the top left of a plain field of twice its size, so that the filter's wrap-around
/// meets nothing.
cv::Mat padded_pattern(const Stimulus& stimulus, double ppd) {
  constexpr double kContrast = 0.5;
  const Image image = stimulus_image(stimulus, kContrast, 1.0, ppd);
  cv::Mat padded = cv::Mat::zeros(cv::getOptimalDFTSize(2 * image.height_px),
                                  cv::getOptimalDFTSize(2 * image.width_px), CV_64FC1);
  for (int y = 0; y < image.height_px; ++y) {
    auto* row = padded.ptr<double>(y);
    for (int x = 0; x < image.width_px; ++x) {
      row[x] = (static_cast<double>(image.at(x, y)) - 1.0) / kContrast;
    }
  }
  return padded;
}

/// Signed frequency of a DFT's bin, cycles per degree.
double bin_cpd(int bin, int size, double ppd) {
  return (bin <= size / 2 ? bin : bin - size) * ppd / size;
}

void filter_by_csf(cv::Mat& pattern, double mean_cd_m2, double ppd, const CsfInfo& csf) {
  cv::Mat spectrum;
  cv::dft(pattern, spectrum, cv::DFT_COMPLEX_OUTPUT);
  const int width = spectrum.cols;
  const auto rows = static_cast<std::size_t>(spectrum.rows);
  base::parallel_for(rows, kGrainRows, [&](std::size_t y, std::size_t end) {
    StimulusConditions conditions = conditions_of(anchor_patch(), 0.0);
    for (; y < end; ++y) {
      auto* row = spectrum.ptr<std::complex<double>>(static_cast<int>(y));
      auto* mirrored = spectrum.ptr<std::complex<double>>(static_cast<int>((rows - y) % rows));
      const double fy = bin_cpd(static_cast<int>(y), spectrum.rows, ppd);
      // A CSF is the same for (fx, fy) and (-fx, -fy): half of the columns tell all.
      for (int x = 0; x <= width / 2; ++x) {
        const double fx = bin_cpd(x, width, ppd);
        conditions.orientation_deg = std::atan2(fy, fx) * 180.0 / std::numbers::pi;
        const double gain = contrast_sensitivity(csf, std::hypot(fx, fy), mean_cd_m2, conditions);
        row[x] *= gain;
        const int opposite = (width - x) % width;
        if (opposite > width / 2) mirrored[opposite] *= gain;
      }
    }
  });
  cv::dft(spectrum, pattern, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
}

/// Minkowski sum over the stimulus under the aperture, per unit contrast.
double pooled_response(const Stimulus& stimulus, double mean_cd_m2, double ppd,
                       const PatternObserver& observer) {
  cv::Mat pattern = padded_pattern(stimulus, ppd);
  filter_by_csf(pattern, mean_cd_m2, ppd, find_csf(observer.csf));
  const auto width = static_cast<int>(std::lround(stimulus.width_deg * ppd));
  const auto height = static_cast<int>(std::lround(stimulus.height_deg * ppd));
  double sum = 0.0;
  for (int y = 0; y < height; ++y) {
    const double y_deg = (y - 0.5 * (height - 1)) / ppd;
    for (int x = 0; x < width; ++x) {
      const double x_deg = (x - 0.5 * (width - 1)) / ppd;
      const double squared =
          (x_deg * x_deg + y_deg * y_deg) / (observer.aperture_deg * observer.aperture_deg);
      const double seen = std::exp(-0.5 * squared) * pattern.at<double>(y, x);
      sum += std::pow(std::abs(seen), observer.pooling_exponent);
    }
  }
  return std::pow(sum / (ppd * ppd), 1.0 / observer.pooling_exponent);
}

}  // namespace

void check(const PatternObserver& observer, const base::Place& place) {
  const CsfInfo& csf = find_csf(observer.csf, place);
  if (csf.normalization == CsfNormalization::cone) {
    throw base::InputError(
        place, fmt::format("csf \"{}\" is of colour; accepted: achromatic functions", csf.name));
  }
  if (!(observer.pooling_exponent >= 1.0)) {
    throw base::InputError(place, fmt::format("pooling_exponent is {}; accepted: 1 and above",
                                              observer.pooling_exponent));
  }
  if (!(observer.aperture_deg > 0.0)) {
    throw base::InputError(
        place, fmt::format("aperture_deg is {}; accepted: above 0", observer.aperture_deg));
  }
}

double pattern_threshold(const Stimulus& stimulus, double mean_cd_m2, double pixels_per_degree,
                         const PatternObserver& observer) {
  check(observer);
  // The anchor's own field: large enough for its envelope, fine enough for its frequency.
  constexpr double kAnchorSize_deg = 3.0;
  constexpr double kAnchorPpd = 40.0;
  const double anchor = pooled_response(gabor_stimulus(anchor_patch(), kAnchorSize_deg), mean_cd_m2,
                                        kAnchorPpd, observer);
  const double response = pooled_response(stimulus, mean_cd_m2, pixels_per_degree, observer);
  return gabor_threshold(anchor_patch(), mean_cd_m2, observer.csf) * anchor / response;
}

double gabor_threshold(const GaborPatch& patch, double mean_cd_m2, const std::string& csf,
                       double eccentricity_deg) {
  return 1.0 / contrast_sensitivity(find_csf(csf), patch.frequency_cpd, mean_cd_m2,
                                    conditions_of(patch, eccentricity_deg));
}

}  // namespace perception
