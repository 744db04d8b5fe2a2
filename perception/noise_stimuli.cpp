// Schmittwilken, Wichmann, Maertens 2024, "Standard Models of Spatial Vision Mispredict Edge
// Sensitivity at Low Spatial Frequencies", doi:10.1016/j.visres.2024.108450: Cornsweet edges in
// noise; parameters from the authors' published stimulus code.

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include <opencv2/core.hpp>

#include "perception/base/errors.h"
#include "perception/opencv_view.h"
#include "perception/stimuli.h"

namespace perception {
namespace {

void require(bool is_fine, const char* what, double value, const char* accepted) {
  if (is_fine) return;
  throw base::InputError(fmt::format("{} is {}; accepted: {}", what, value, accepted));
}

/// Normal numbers from uniform ones (Box, Muller 1958): the standard library's own sequence
/// differs between machines.
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : engine_(seed) {}
  double next() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  /// In (0, 1].
  double uniform() { return (static_cast<double>(engine_() >> 11) + 1.0) * 0x1p-53; }
  std::mt19937_64 engine_;
};

double amplitude(NoiseKind kind, double cpd, double centre_cpd) {
  switch (kind) {
    case NoiseKind::none:
      return 0.0;
    case NoiseKind::white:
      return 1.0;
    case NoiseKind::pink:
      return 1.0 / cpd;
    case NoiseKind::brown:
      return 1.0 / (cpd * cpd);
    case NoiseKind::narrow_band: {
      const double octaves = std::log2(cpd / centre_cpd);
      return std::exp2(-octaves * octaves / 0.25);  // one half at 0.5 octaves
    }
  }
  return 0.0;
}

/// Multiplies the spectrum by the amplitude and removes the mean.
void shape_spectrum(cv::Mat& spectrum, NoiseKind kind, double ppd, double centre_cpd) {
  const int size = spectrum.rows;
  const auto cpd_of = [&](int i) { return (i <= size / 2 ? i : i - size) * ppd / size; };
  for (int y = 0; y < size; ++y) {
    auto* row = spectrum.ptr<std::complex<double>>(y);
    for (int x = 0; x < size; ++x) {
      const double cpd = std::hypot(cpd_of(x), cpd_of(y));
      row[x] *= cpd > 0.0 ? amplitude(kind, cpd, centre_cpd) : 0.0;
    }
  }
}

double mean_square(const cv::Mat& values) {
  double sum = 0.0;
  for (int y = 0; y < values.rows; ++y) {
    const auto* row = values.ptr<double>(y);
    for (int x = 0; x < values.cols; ++x) sum += row[x] * row[x];
  }
  return sum / static_cast<double>(values.total());
}

/// +-(1 - |y| / ramp) up to the ramp's width, with unit root mean square over the image.
std::vector<double> edge_rows(const EdgeInNoise& p, int size_px) {
  std::vector<double> rows;
  double sum = 0.0;
  for (int y = 0; y < size_px; ++y) {
    const double y_deg = (y - 0.5 * (size_px - 1)) / p.pixels_per_degree;
    const double height = std::max(0.0, 1.0 - std::abs(y_deg) / p.ramp_deg);
    rows.push_back(y_deg < 0.0 ? -height : height);
    sum += height * height;
  }
  require(sum > 0.0, "the edge's ramp", p.ramp_deg, "more than half a pixel");
  const double rms = std::sqrt(sum / size_px);
  for (double& row : rows) row /= rms;
  return rows;
}

}  // namespace

Image noise_pattern(NoiseKind kind, int size_px, double pixels_per_degree, double centre_cpd,
                    std::uint64_t seed) {
  require(size_px >= 2 || kind == NoiseKind::none, "the size of noise", size_px, "2 and more");
  require(pixels_per_degree > 0.0, "pixels per degree", pixels_per_degree, "above 0");
  require(kind != NoiseKind::narrow_band || centre_cpd > 0.0, "the noise's centre", centre_cpd,
          "above 0");
  Image image = make_gray_image(size_px, size_px, "C", Encoding::luminance_cd_m2);
  if (kind == NoiseKind::none) return image;
  NormalNumbers normal(seed);
  cv::Mat values(size_px, size_px, CV_64FC1);
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) values.at<double>(y, x) = normal.next();
  }
  cv::Mat spectrum;
  cv::dft(values, spectrum, cv::DFT_COMPLEX_OUTPUT);
  shape_spectrum(spectrum, kind, pixels_per_degree, centre_cpd);
  cv::dft(spectrum, values, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  const double rms = std::sqrt(mean_square(values));
  require(rms > 0.0, "the noise's centre", centre_cpd, "a frequency the image can hold");
  cv::Mat view = opencv_view(image);
  values.convertTo(view, CV_32F, 1.0 / rms);
  return image;
}

StimulusPair edge_in_noise(const EdgeInNoise& p) {
  require(p.ramp_deg > 0.0, "the edge's ramp", p.ramp_deg, "above 0 degrees");
  require(p.edge_rms >= 0.0, "the edge's contrast", p.edge_rms, "0 and above");
  require(p.noise_rms >= 0.0, "the noise's contrast", p.noise_rms, "0 and above");
  require(p.mean_cd_m2 > 0.0, "mean luminance", p.mean_cd_m2, "above 0");
  require(p.pixels_per_degree > 0.0, "pixels per degree", p.pixels_per_degree, "above 0");
  require(p.size_deg * p.pixels_per_degree >= 2.0, "the size", p.size_deg, "2 pixels and more");
  const auto size_px = static_cast<int>(std::lround(p.size_deg * p.pixels_per_degree));
  const Image noise =
      noise_pattern(p.noise, size_px, p.pixels_per_degree, p.noise_centre_cpd, p.seed);
  const std::vector<double> edge = edge_rows(p, size_px);
  StimulusPair pair;
  pair.reference = make_gray_image(size_px, size_px, "Y", Encoding::luminance_cd_m2);
  pair.test = pair.reference;
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const double masked = 1.0 + p.noise_rms * static_cast<double>(noise.at(x, y));
      const double shown = masked + p.edge_rms * edge[static_cast<std::size_t>(y)];
      pair.reference.at(x, y) = static_cast<float>(p.mean_cd_m2 * masked);
      pair.test.at(x, y) = static_cast<float>(p.mean_cd_m2 * shown);
    }
  }
  return pair;
}

}  // namespace perception
