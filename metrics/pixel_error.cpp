#include "metrics/pixel_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"

namespace metrics {
namespace {

constexpr int kChannels = 3;
/// Keeps the relative errors finite at black, in squared and plain radiance (see the header).
constexpr double kRelativeOffset = 0.01;

using Formula = double (*)(double test, double reference);

double squared(double x, double r) { return (x - r) * (x - r); }
double relative_squared(double x, double r) {
  return (x - r) * (x - r) / (r * r + kRelativeOffset);
}
double absolute(double x, double r) { return std::abs(x - r); }
double reference_value(double, double r) { return r; }
double symmetric_relative(double x, double r) {
  return std::abs(x - r) / (std::abs(x) + std::abs(r) + kRelativeOffset);
}

Image error_map_of(const Image& size) {
  return perception::make_gray_image(size.width_px, size.height_px, "error",
                                     perception::Encoding::scene_linear);
}

/// Pixels whose errors are found side by side, before they are summed.
constexpr int kChunkPx = 64;

/// Sum over a row, in lanes, so that additions do not wait for each other.
class RowSum {
 public:
  void add(std::size_t at, double value) { lanes_[at % lanes_.size()] += value; }
  double total() const { return (lanes_[0] + lanes_[1]) + (lanes_[2] + lanes_[3]); }

 private:
  std::array<double, 4> lanes_{};
};

/// @param values  channels of pixels one after another  @param errors  receives as many
template <Formula kFormula>
void find_errors(const float* test, const float* reference, int values, double* errors) {
  for (int i = 0; i < values; ++i) errors[i] = kFormula(double{test[i]}, double{reference[i]});
}

/// Mean over pixels and channels, in double precision.
/// @param map  gets the mean over the channels of every pixel on the same way through the images,
///             which takes as long as reading them does; null for none
template <Formula kFormula>
double mean_error(const Image& reference, const Image& test, const Image* mask, Image* map) {
  const auto row_sum = [&](int y) {
    const std::size_t first_pixel = reference.offset(0, y) / kChannels;
    const float* r = &reference.pixels[reference.offset(0, y)];
    const float* x = &test.pixels[test.offset(0, y)];
    float* out = map != nullptr ? &map->pixels[map->offset(0, y)] : nullptr;
    std::array<double, kChannels * kChunkPx> errors;
    RowSum sum;
    for (int first = 0; first < reference.width_px; first += kChunkPx) {
      const int count = std::min(kChunkPx, reference.width_px - first);
      find_errors<kFormula>(x + kChannels * first, r + kChannels * first, kChannels * count,
                            errors.data());
      for (int i = 0; i < count; ++i) {
        const double* channels = &errors[static_cast<std::size_t>(kChannels * i)];
        const double pixel = channels[0] + channels[1] + channels[2];
        if (out != nullptr) out[first + i] = static_cast<float>(pixel * (1.0 / kChannels));
        const auto at = static_cast<std::size_t>(first + i);
        if (takes_part(mask, first_pixel + at)) sum.add(at, pixel);
      }
    }
    return sum.total();
  };
  const auto values = static_cast<double>(pooled_pixel_count(reference, mask)) * kChannels;
  return sum_over_rows(reference.height_px, row_sum) / values;
}

/// As `mean_error`, without the largest channel errors.
template <Formula kFormula>
double trimmed_error(const ImagePair& linear, double trim) {
  std::vector<float> errors;
  errors.reserve(linear.reference.pixels.size());
  for (std::size_t i = 0; i < linear.reference.pixels.size(); ++i) {
    if (!takes_part(linear.mask, i / kChannels)) continue;
    errors.push_back(static_cast<float>(
        kFormula(double{linear.test.pixels[i]}, double{linear.reference.pixels[i]})));
  }
  return trimmed_mean(errors, trim);
}

template <Formula kFormula>
class PixelError : public Metric {
 public:
  PixelError(std::string name, double trim) : name_(std::move(name)), trim_(trim) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions&) const override {
    const InputImage reference = linear_input(pair.reference, name_);
    const InputImage test = linear_input(pair.test, name_);
    Score score;
    score.map = error_map_of(reference.image());
    score.value =
        mean_error<kFormula>(reference.image(), test.image(), pair.mask, &score.map.value());
    if (trim_ > 0.0) {
      const ImagePair linear{reference.image(), test.image(), nullptr, pair.mask};
      score.value = trimmed_error<kFormula>(linear, trim_);
    }
    return score;
  }

  /// Errors of finite floats are finite doubles, and their sum is; trimming drops errors.
  bool shows_non_finite() const override { return trim_ == 0.0; }

 private:
  std::string name_;
  double trim_;
};

/// Mean over pixels and channels.
double mean_value(const Image& image, const Image* mask) {
  return mean_error<reference_value>(image, image, mask, nullptr);
}

class RelativeRmse : public Metric {
 public:
  explicit RelativeRmse(double trim) : trim_(trim) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const double mean = mean_value(linear_input(pair.reference, kName).image(), pair.mask);
    const double scale = mean > 0.0 ? 1.0 / mean : std::numeric_limits<double>::quiet_NaN();
    Score score = PixelError<squared>(kName, trim_).evaluate(pair, viewing);
    score.details = {{"mse", score.value}, {"reference_mean", mean}};
    score.value = score.value == 0.0 ? 0.0 : std::sqrt(score.value) * scale;
    for_each_pixel(*score.map, [&](std::size_t i) {
      float& error = score.map->pixels[i];
      error = mean > 0.0 ? static_cast<float>(std::sqrt(double{error}) * scale) : 0.0F;
    });
    return score;
  }

  static constexpr const char* kName = "relative-rmse";

 private:
  double trim_;
};

class PeakSignalToNoise : public Metric {
 public:
  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const InputImage reference = display_input(pair.reference, viewing, "psnr");
    const InputImage test = display_input(pair.test, viewing, "psnr");
    Score score;
    score.map = error_map_of(reference.image());
    const double mse =
        mean_error<squared>(reference.image(), test.image(), pair.mask, &score.map.value());
    score.value = mse > 0.0 ? -10.0 * std::log10(mse) : std::numeric_limits<double>::infinity();
    score.details.push_back({"mse", mse});
    return score;
  }
};

base::ParameterSpec trim_parameter() {
  constexpr double kMostTrimmed = 0.5;
  return base::real_parameter(
      "trim", 0.0, {0.0, kMostTrimmed}, "",
      "fraction of the largest channel errors that is dropped; the mean divides by the rest (ours: "
      "0, so that fireflies count)");
}

MetricInfo linear_error_info(std::string name, std::string summary, std::string source) {
  MetricInfo info;
  info.name = std::move(name);
  info.summary = std::move(summary);
  info.source = std::move(source);
  info.better = Better::lower;
  info.input = "scene-linear RGB";
  info.identical_value = 0.0;
  info.parameters = {trim_parameter()};
  return info;
}

}  // namespace

MetricInfo mse_info() {
  MetricInfo info =
      linear_error_info("mse", "Mean squared error: mean of (x - r)^2 over pixels and channels.",
                        "textbook definition");
  info.unit = "squared radiance";
  info.map_unit = info.unit;
  info.map_scale = {1e-6, 1.0, true, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<PixelError<squared>>("mse", parameters.real("trim"));
  };
  return info;
}

MetricInfo relmse_info() {
  MetricInfo info = linear_error_info(
      "relmse",
      "Relative mean squared error: mean of (x - r)^2 / (r^2 + 0.01) over pixels and channels.",
      "Rousselle et al. 2011, doi:10.1145/2024156.2024193");
  info.map_scale = {1e-4, 10.0, true, ""};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<PixelError<relative_squared>>("relmse", parameters.real("trim"));
  };
  return info;
}

MetricInfo relative_rmse_info() {
  MetricInfo info = linear_error_info(
      RelativeRmse::kName,
      "Root of the mean squared error over the reference's mean, both over pixels and channels; "
      "n/a for a black reference.",
      "textbook definition");
  info.map_scale = {1e-2, 10.0, true, ""};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<RelativeRmse>(parameters.real("trim"));
  };
  return info;
}

MetricInfo mae_info() {
  MetricInfo info =
      linear_error_info("mae", "Mean absolute error: mean of |x - r| over pixels and channels.",
                        "textbook definition");
  info.unit = "radiance";
  info.map_unit = info.unit;
  info.map_scale = {1e-3, 1.0, true, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<PixelError<absolute>>("mae", parameters.real("trim"));
  };
  return info;
}

MetricInfo smape_info() {
  MetricInfo info = linear_error_info("smape",
                                      "Symmetric mean absolute relative error: mean of |x - r| / "
                                      "(|x| + |r| + 0.01) over pixels and channels.",
                                      "Vogels et al. 2018, doi:10.1145/3197517.3201388");
  info.map_scale = {0.0, 1.0, false, ""};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<PixelError<symmetric_relative>>("smape", parameters.real("trim"));
  };
  return info;
}

MetricInfo psnr_info() {
  MetricInfo info;
  info.name = "psnr";
  info.summary =
      "Peak signal-to-noise ratio: -10 log10 of the mean squared error of sRGB-encoded values with "
      "peak 1; infinite for equal pictures. The map is the squared error.";
  info.unit = "dB";
  info.source = "textbook definition";
  info.better = Better::higher;
  info.input = "sRGB-encoded";
  info.identical_value = std::numeric_limits<double>::infinity();
  info.map_unit = "squared signal";
  info.map_scale = {1e-6, 1.0, true, info.map_unit};
  info.create = [](const base::Parameters&) -> std::unique_ptr<Metric> {
    return std::make_unique<PeakSignalToNoise>();
  };
  return info;
}

}  // namespace metrics
