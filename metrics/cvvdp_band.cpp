#include "metrics/cvvdp_band.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "metrics/cvvdp_pyramid.h"
#include "metrics/score_pooling.h"
#include "metrics/vector_math.h"

namespace metrics {
namespace {

// Constants of the published calibration, version 0.5.7, to six or seven digits.
constexpr float kLowestBackground_cd_m2 = 0.01F;
constexpr float kHighestContrast = 1000.0F;
constexpr double kSensitivityCorrection_dB = -0.2797423;
/// Gain of a channel's contrast before masking.
constexpr std::array<float, kCvvdpChannels> kChannelGain{1.0F, 1.45F, 1.0F};
constexpr double kMaskGain_log10 = -0.7954971;
constexpr double kMaskSigma_px = 3.0;
constexpr int kMaskRadius_px = 6;
constexpr float kDifferencePower = 2.264355F;                                             // p
constexpr std::array<float, kCvvdpChannels> kMaskPower{1.302623F, 2.888591F, 3.680771F};  // q
/// log2 of the weight of masking by a channel (row) on a channel (column).
constexpr double kCrossMasking_log2[kCvvdpChannels][kCvvdpChannels] = {
    {-0.189501, -5.962151, -4.318346},
    {2.565559, 0.344067, -2.719646},
    {3.811837, -1.005171, -0.519338}};
constexpr double kLargestDifference_log10 = 2.564245;
constexpr auto kPowerOffset = static_cast<float>(kCvvdpPowerOffset);

using Row = std::vector<float>;

float larger(float a, float b) { return a > b ? a : b; }
float smaller(float a, float b) { return a < b ? a : b; }

/// cvvdp_power for rows. @param at_zero  power_of(kPowerOffset, p)
float offset_power(float x, float p, float at_zero) {
  return power_of(x + kPowerOffset, p) - at_zero;
}

/// Sensitivity of the channels along a row, from the background's luminance.
class RowSensitivity {
 public:
  RowSensitivity(const CvvdpSensitivityCurves& curves, int width_px)
      : positions_(static_cast<std::size_t>(width_px)) {
    const double correction = kSensitivityCorrection_dB / 20.0;
    for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
      for (std::size_t l = 0; l < kCvvdpLuminances; ++l) {
        log2_[c][l] = static_cast<float>((curves[c][l] + correction) * std::log2(10.0));
      }
    }
  }

  void set_background(const Row& luminance_cd_m2) {
    constexpr auto kLast = static_cast<float>(kCvvdpLuminances - 1);
    const auto lowest = static_cast<float>(std::log2(kCvvdpLowest_cd_m2));
    const auto scale =
        kLast / static_cast<float>(std::log2(kCvvdpHighest_cd_m2) - std::log2(kCvvdpLowest_cd_m2));
    for (std::size_t x = 0; x < positions_.size(); ++x) {
      const float position = (log2_of(luminance_cd_m2[x]) - lowest) * scale;
      positions_[x] = smaller(larger(position, 0.0F), kLast);
    }
  }

  void get(std::size_t channel, Row& sensitivity) const {
    const auto& curve = log2_[channel];
    for (std::size_t x = 0; x < positions_.size(); ++x) {
      const int below = std::min(static_cast<int>(positions_[x]), int{kCvvdpLuminances} - 2);
      const float share = positions_[x] - static_cast<float>(below);
      const auto i = static_cast<std::size_t>(below);
      sensitivity[x] = curve[i] + share * (curve[i + 1] - curve[i]);
    }
    for (std::size_t x = 0; x < positions_.size(); ++x) sensitivity[x] = exp2_of(sensitivity[x]);
  }

 private:
  std::array<std::array<float, kCvvdpLuminances>, kCvvdpChannels> log2_;
  Row positions_;
};

/// Weber contrast along a row of one channel, in place of the expanded background.
void to_contrast(const float* fine, const Row& background, float gain, Row& expanded) {
  for (std::size_t x = 0; x < expanded.size(); ++x) {
    expanded[x] = gain * smaller((fine[x] - expanded[x]) / background[x], kHighestContrast);
  }
}

/// What masking needs of a band: the smaller of both pictures' visible contrasts, and how far they
/// are apart.
struct VisibleContrast {
  CvvdpChannelPlanes shared;
  CvvdpChannelPlanes difference;
};

/// One row of a picture: expanded coarse level, then contrast.
struct PictureRow {
  explicit PictureRow(std::size_t width) : background(width) {
    for (Row& row : channels) row.resize(width);
  }

  void read(const CvvdpChannelPlanes& fine, const CvvdpChannelPlanes& coarse, int y, float gain) {
    const int width_px = fine[0].width_px;
    for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
      cvvdp_expand_row(coarse[c], y, width_px, channels[c].data());
    }
    for (std::size_t x = 0; x < background.size(); ++x) {
      background[x] = larger(channels[0][x], kLowestBackground_cd_m2);
    }
    for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
      to_contrast(fine[c].row(y), background, gain, channels[c]);
    }
  }

  Row background;
  std::array<Row, kCvvdpChannels> channels;
};

VisibleContrast visible_contrast(const CvvdpLevel& fine, const CvvdpLevel& coarse,
                                 const CvvdpSensitivityCurves& curves, double gain) {
  const Plane<float>& size = fine.reference[0];
  VisibleContrast visible;
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
    visible.shared[c] = Plane<float>(size.width_px, size.height_px);
    visible.difference[c] = Plane<float>(size.width_px, size.height_px);
  }
  for_each_row(size.height_px, [&](int y) {
    const auto width = static_cast<std::size_t>(size.width_px);
    PictureRow reference(width), test(width);
    reference.read(fine.reference, coarse.reference, y, static_cast<float>(gain));
    test.read(fine.test, coarse.test, y, static_cast<float>(gain));
    RowSensitivity row_sensitivity(curves, size.width_px);
    row_sensitivity.set_background(reference.background);
    Row sensitivity(width);
    for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
      row_sensitivity.get(c, sensitivity);
      const float *r = reference.channels[c].data(), *t = test.channels[c].data();
      float* __restrict shared = visible.shared[c].row(y);
      float* __restrict difference = visible.difference[c].row(y);
      for (std::size_t x = 0; x < width; ++x) {
        const float scale = sensitivity[x] * kChannelGain[c];
        const float seen_r = r[x] * scale;
        const float seen_t = t[x] * scale;
        shared[x] = smaller(std::abs(seen_r), std::abs(seen_t));
        difference[x] = std::abs(seen_t - seen_r);
      }
    }
  });
  return visible;
}

/// The Gaussian over which masking spreads, sum 1.
Kernel<float> masking_kernel() {
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = -kMaskRadius_px; i <= kMaskRadius_px; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (kMaskSigma_px * kMaskSigma_px)));
    sum += weights.back();
  }
  Kernel<float> kernel;
  for (const double weight : weights) kernel.weights.push_back(static_cast<float>(weight / sum));
  return kernel;
}

/// Blurs a plane; borders are mirrored at the border pixel's centre.
void blur(const Kernel<float>& kernel, Plane<float>& plane) {
  Plane<float> along(plane.width_px, plane.height_px);
  for_each_row(plane.height_px, [&](int y) {
    PaddedRow<float> row(plane.width_px, kMaskRadius_px);
    std::copy_n(plane.row(y), plane.width_px, row.data());
    row.mirror_ends();
    row.filter(kernel, along.row(y));
  });
  for_each_row(plane.height_px, [&](int y) {
    std::vector<const float*> rows;
    for (int i = y - kMaskRadius_px; i <= y + kMaskRadius_px; ++i) {
      const int last = plane.height_px - 1;
      rows.push_back(along.row(i < 0 ? -i : i > last ? 2 * last - i : i));
    }
    weighted_sum(kernel.weights, rows, static_cast<std::size_t>(plane.width_px), plane.row(y));
  });
}

/// Spreads what masks to the neighbourhood, as far as the band is large enough for it.
void spread(CvvdpChannelPlanes& shared) {
  if (shared[0].width_px <= kMaskRadius_px || shared[0].height_px <= kMaskRadius_px) return;
  const Kernel<float> kernel = masking_kernel();
  for (Plane<float>& plane : shared) blur(kernel, plane);
}

/// Divides the differences of a row by 1 + masking from all channels, and clamps them softly.
void mask_row(const VisibleContrast& visible, int y, CvvdpChannelPlanes& difference) {
  const auto width = static_cast<std::size_t>(difference[0].width_px);
  const auto gain = static_cast<float>(std::pow(10.0, kMaskGain_log10));
  const auto largest = static_cast<float>(std::pow(10.0, kLargestDifference_log10));
  std::array<Row, kCvvdpChannels> terms;
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
    terms[c].resize(width);
    const float* shared = visible.shared[c].row(y);
    const float at_zero = power_of(kPowerOffset, kMaskPower[c]);
    for (std::size_t x = 0; x < width; ++x) {
      terms[c][x] = offset_power(gain * shared[x], kMaskPower[c], at_zero);
    }
  }
  const float at_zero = power_of(kPowerOffset, kDifferencePower);
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
    std::array<float, kCvvdpChannels> w{};
    for (std::size_t i = 0; i < kCvvdpChannels; ++i) {
      w[i] = static_cast<float>(std::exp2(kCrossMasking_log2[i][c]));
    }
    const float *a = terms[0].data(), *b = terms[1].data(), *d = terms[2].data();
    float* __restrict out = difference[c].row(y);
    for (std::size_t x = 0; x < width; ++x) {
      const float masking = 1.0F + (w[0] * a[x] + w[1] * b[x] + w[2] * d[x]);
      const float raised = offset_power(out[x], kDifferencePower, at_zero) / masking;
      const float positive = larger(raised, 0.0F);
      out[x] = largest * positive / (largest + positive);
    }
  }
}

double mean_background(const Plane<float>& achromatic) {
  const double sum = sum_over_rows(achromatic.height_px, [&](int y) {
    double row_sum = 0.0;
    for (int x = 0; x < achromatic.width_px; ++x) {
      row_sum += double{larger(achromatic.row(y)[x], kLowestBackground_cd_m2)};
    }
    return row_sum;
  });
  return sum / static_cast<double>(achromatic.values.size());
}

}  // namespace

double cvvdp_power(double x, double p) {
  return std::pow(x + kCvvdpPowerOffset, p) - std::pow(kCvvdpPowerOffset, p);
}

CvvdpChannelPlanes cvvdp_band_difference(const CvvdpLevel& fine, const CvvdpLevel& coarse,
                                         const CvvdpSensitivityCurves& curves, double gain) {
  VisibleContrast visible = visible_contrast(fine, coarse, curves, gain);
  spread(visible.shared);
  CvvdpChannelPlanes difference = std::move(visible.difference);
  for_each_row(difference[0].height_px, [&](int y) { mask_row(visible, y, difference); });
  return difference;
}

CvvdpChannelPlanes cvvdp_base_difference(const CvvdpLevel& last,
                                         const CvvdpSensitivityCurves& curves) {
  const double reference_mean = mean_background(last.reference[0]);
  const double test_mean = mean_background(last.test[0]);
  const double correction = std::pow(10.0, kSensitivityCorrection_dB / 20.0);
  CvvdpChannelPlanes difference = last.test;
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
    const double sensitivity = correction * cvvdp_sensitivity_of(curves[c], reference_mean);
    for (std::size_t i = 0; i < difference[c].values.size(); ++i) {
      const double t =
          std::min(double{last.test[c].values[i]} / test_mean, double{kHighestContrast});
      const double r =
          std::min(double{last.reference[c].values[i]} / reference_mean, double{kHighestContrast});
      difference[c].values[i] = static_cast<float>(std::abs(t - r) * sensitivity);
    }
  }
  return difference;
}

}  // namespace metrics
