// Carney et al. 1999, "Development of an Image/Threshold Database for Designing and Testing Human
// Vision Models", doi:10.1117/12.348473. Parameters from the organisers' stimulus list and data
// pages; the equation is theirs: cos(2 pi f y) exp(-((x / Sx)^2 + (y / Sy)^2) / 2), horizontal
// bars.

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/stimuli.h"

namespace perception {
namespace {

constexpr double kSize_deg = 256.0 / kModelFestPixelsPerDegree;
constexpr double kPixel_deg = 1.0 / kModelFestPixelsPerDegree;  ///< half a minute of arc
constexpr double kWide_deg = 0.5;                               ///< sigma of most envelopes
constexpr int kSharp = 4;                                       ///< samples along a pixel's side
constexpr double kHorizontalBars_deg = 90.0;

double gaussian(double x, double y, double sigma) {
  return std::exp(-0.5 * (x * x + y * y) / (sigma * sigma));
}

GaborPatch patch_of(double frequency, double along, double across,
                    double orientation = kHorizontalBars_deg) {
  return {.frequency_cpd = frequency,
          .sigma_along_deg = along,
          .sigma_across_deg = across,
          .orientation_deg = orientation};
}

/// Collects the stimuli in their order.
class List {
 public:
  void add(int number, std::string description, std::function<double(double, double)> pattern,
           int samples_per_side = 1) {
    stimuli_.push_back({number,
                        {fmt::format("modelfest-{:02}", number), std::move(description), kSize_deg,
                         kSize_deg, std::move(pattern), samples_per_side}});
  }

  /// Weighted sum of patches.
  void add_patches(int number, std::string description, std::vector<GaborPatch> patches,
                   std::vector<double> weights) {
    add(number, std::move(description), [=](double x, double y) {
      double sum = 0.0;
      for (std::size_t i = 0; i < patches.size(); ++i) {
        sum += weights[i] * gabor_value(patches[i], x, y);
      }
      return sum;
    });
  }

  void add_gabor(int number, const GaborPatch& p) {
    add_patches(number,
                fmt::format("Gabor patch, {:g} cpd, sigma {:g} x {:g} deg", p.frequency_cpd,
                            p.sigma_along_deg, p.sigma_across_deg),
                {p}, {1.0});
    stimuli_.back().stimulus.gabor = p;
  }

  std::vector<ModelFestStimulus> take() { return std::move(stimuli_); }

 private:
  std::vector<ModelFestStimulus> stimuli_;
};

/// 1 to 21: one Gabor patch each.
void add_single_gabors(List& list) {
  constexpr std::array<double, 10> kFrequencies{1.12, 2.0,  2.83, 4.0,  5.66,
                                                8.0,  11.3, 16.0, 22.6, 30.0};
  for (int i = 0; i < 10; ++i) {
    list.add_gabor(1 + i,
                   patch_of(kFrequencies[static_cast<std::size_t>(i)], kWide_deg, kWide_deg));
  }
  for (int i = 0; i < 4; ++i) {
    const double sigma = 0.28 / std::exp2(i);  // one octave: 0.56 cycles
    list.add_gabor(11 + i, patch_of(std::exp2(i + 1), sigma, sigma));
  }
  for (int i = 0; i < 3; ++i) {
    list.add_gabor(15 + i, patch_of(std::exp2(i + 2), 0.28 / std::exp2(i), kWide_deg));
  }
  list.add_gabor(18, patch_of(4.0, 0.14, 0.28));
  list.add_gabor(19, patch_of(4.0, 0.14, 0.5));
  list.add_gabor(20, patch_of(4.0, 0.28, 0.14));
  list.add_gabor(21, patch_of(4.0, 0.5, 0.14));
}

/// 22 to 25: two frequencies at half amplitude.
void add_frequency_pairs(List& list) {
  constexpr double kPairs[4][2] = {
      {2.0, 2.0 * std::numbers::sqrt2}, {2.0, 4.0}, {4.0, 4.0 * std::numbers::sqrt2}, {4.0, 8.0}};
  for (int i = 0; i < 4; ++i) {
    const auto& [low, high] = kPairs[i];
    list.add_patches(22 + i, fmt::format("Gabor pair, {:g} and {:.4g} cpd", low, high),
                     {patch_of(low, kWide_deg, kWide_deg), patch_of(high, kWide_deg, kWide_deg)},
                     {0.5, 0.5});
  }
}

/// 26 to 29: Gaussian blobs; 30 to 32: edge, line and dipole under a Gaussian.
void add_blobs_and_lines(List& list) {
  constexpr std::array<double, 4> kSigma_arcmin{30.0, 8.43, 2.106, 1.05};
  for (int i = 0; i < 4; ++i) {
    const double sigma = kSigma_arcmin[static_cast<std::size_t>(i)] / 60.0;
    list.add(26 + i, fmt::format("Gaussian, sigma {:g} arcmin", sigma * 60.0),
             [=](double x, double y) { return gaussian(x, y, sigma); });
  }
  list.add(
      30, "edge x Gaussian",
      [](double x, double y) { return (y < 0.0 ? -1.0 : 1.0) * gaussian(x, y, kWide_deg); },
      kSharp);
  // The row of pixels below the centre at the original resolution.
  list.add(
      31, "line of 0.5 arcmin x Gaussian",
      [](double x, double y) {
        return y >= 0.0 && y < kPixel_deg ? gaussian(x, y, kWide_deg) : 0.0;
      },
      kSharp);
  list.add(
      32, "dipole, 3 pixels: -1, 0, 1, x Gaussian",
      [](double x, double y) {
        if (y >= -kPixel_deg && y < 0.0) return -gaussian(x, y, kWide_deg);
        return y >= kPixel_deg && y < 2.0 * kPixel_deg ? gaussian(x, y, kWide_deg) : 0.0;
      },
      kSharp);
}

/// 33, 34: five Gabors in a row, 5 sigma apart, in phase or alternating.
void add_gabor_rows(List& list) {
  constexpr double kSigma_deg = 0.07;
  std::vector<GaborPatch> patches;
  for (int i = -2; i <= 2; ++i) {
    patches.push_back(patch_of(8.0, kSigma_deg, kSigma_deg));
    patches.back().x_deg = 5.0 * kSigma_deg * i;
  }
  list.add_patches(33, "five collinear Gabors, in phase", patches, {1.0, 1.0, 1.0, 1.0, 1.0});
  list.add_patches(34, "five collinear Gabors, alternating", patches, {1.0, -1.0, 1.0, -1.0, 1.0});
}

/// 36 to 39: orientations and plaids; 40 to 42: disk, Bessel function, checkerboard.
void add_shapes(List& list) {
  const auto octave = [](double orientation) { return patch_of(4.0, 0.14, 0.14, orientation); };
  list.add_gabor(36, octave(45.0));
  list.add_gabor(37, octave(0.0));
  list.add_patches(38, "plaid, 0 and 90 deg", {octave(0.0), octave(90.0)}, {0.5, 0.5});
  list.add_patches(39, "plaid, 45 and 90 deg", {octave(45.0), octave(90.0)}, {0.5, 0.5});
  list.add(
      40, "disk, radius 0.1249 deg",
      [](double x, double y) { return std::hypot(x, y) <= 0.1249 ? 1.0 : 0.0; }, kSharp);
  list.add(41, "Bessel function, 4 cpd, x Gaussian", [](double x, double y) {
    const double r = std::hypot(x, y);
    return std::cyl_bessel_j(0.0, 2.0 * std::numbers::pi * 4.0 * r) * gaussian(x, y, kWide_deg);
  });
  list.add(
      42, "checkerboard, 4 cpd fundamental, x Gaussian",
      [](double x, double y) {
        const double k = 2.0 * std::numbers::pi * 2.81 / std::numbers::sqrt2;
        const double product = std::cos(k * (x + y)) * std::cos(k * (x - y));
        return (product < 0.0 ? -1.0 : 1.0) * gaussian(x, y, kWide_deg);
      },
      kSharp);
}

std::vector<ModelFestStimulus> all_stimuli() {
  List list;
  add_single_gabors(list);
  add_frequency_pairs(list);
  add_blobs_and_lines(list);
  add_gabor_rows(list);
  add_shapes(list);
  return list.take();
}

}  // namespace

std::span<const ModelFestStimulus> modelfest_stimuli() {
  static const std::vector<ModelFestStimulus> kStimuli = all_stimuli();
  return kStimuli;
}

const Stimulus& modelfest_stimulus(int number) {
  for (const ModelFestStimulus& one : modelfest_stimuli()) {
    if (one.number == number) return one.stimulus;
  }
  throw base::InputError(fmt::format(
      "there is no ModelFest stimulus {}; accepted: 1 to 42 without 35 (35 and 43 are image files)",
      number));
}

}  // namespace perception
