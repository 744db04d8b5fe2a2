#include "perception/stimuli.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"

namespace perception {
namespace {

constexpr std::size_t kGrainRows = 8;

void require(bool is_fine, const char* what, double value, const char* accepted) {
  if (is_fine) return;
  throw base::InputError(fmt::format("{} is {}; accepted: {}", what, value, accepted));
}

int pixels_of(double size_deg, double ppd) {
  return std::max(1, static_cast<int>(std::lround(size_deg * ppd)));
}

/// Mean of the pattern over one pixel.
double pixel_mean(const Stimulus& stimulus, double x_px, double y_px, double ppd) {
  const int n = stimulus.samples_per_side;
  double sum = 0.0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double dx = (i + 0.5) / n - 0.5;
      const double dy = (j + 0.5) / n - 0.5;
      sum += stimulus.pattern((x_px + dx) / ppd, (y_px + dy) / ppd);
    }
  }
  return sum / (n * n);
}

Image added(const Image& a, const Image& b, double mean_cd_m2) {
  Image sum = a;
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
    sum.pixels[i] += b.pixels[i] - static_cast<float>(mean_cd_m2);
  }
  return sum;
}

}  // namespace

Image stimulus_image(const Stimulus& stimulus, double contrast, double mean_cd_m2,
                     double pixels_per_degree) {
  require(contrast >= 0.0 && contrast <= 1.0, "contrast", contrast, "0 to 1");
  require(mean_cd_m2 > 0.0, "mean luminance", mean_cd_m2, "above 0");
  require(pixels_per_degree > 0.0, "pixels per degree", pixels_per_degree, "above 0");
  Image image = make_gray_image(pixels_of(stimulus.width_deg, pixels_per_degree),
                                pixels_of(stimulus.height_deg, pixels_per_degree), "Y",
                                Encoding::luminance_cd_m2);
  const double centre_x = 0.5 * (image.width_px - 1);
  const double centre_y = 0.5 * (image.height_px - 1);
  base::parallel_for(
      static_cast<std::size_t>(image.height_px), kGrainRows, [&](std::size_t row, std::size_t end) {
        for (; row < end; ++row) {
          const auto y = static_cast<int>(row);
          for (int x = 0; x < image.width_px; ++x) {
            const double value =
                pixel_mean(stimulus, x - centre_x, y - centre_y, pixels_per_degree);
            image.at(x, y) = static_cast<float>(mean_cd_m2 * (1.0 + contrast * value));
          }
        }
      });
  return image;
}

double gabor_value(const GaborPatch& patch, double x_deg, double y_deg) {
  const double angle = patch.orientation_deg * std::numbers::pi / 180.0;
  const double x = x_deg - patch.x_deg;
  const double y = y_deg - patch.y_deg;
  const double u = x * std::cos(angle) + y * std::sin(angle);
  const double v = y * std::cos(angle) - x * std::sin(angle);
  const double along = u / patch.sigma_along_deg;
  const double across = v / patch.sigma_across_deg;
  const double phase = patch.phase_deg * std::numbers::pi / 180.0;
  return std::cos(2.0 * std::numbers::pi * patch.frequency_cpd * u + phase) *
         std::exp(-0.5 * (along * along + across * across));
}

Stimulus gabor_stimulus(const GaborPatch& patch, double size_deg) {
  return {"gabor",
          fmt::format("Gabor patch, {:g} cpd, sigma {:g} x {:g} deg", patch.frequency_cpd,
                      patch.sigma_along_deg, patch.sigma_across_deg),
          size_deg,
          size_deg,
          [patch](double x, double y) { return gabor_value(patch, x, y); },
          1,
          patch};
}

Stimulus disc_stimulus(double diameter_deg, double size_deg) {
  require(diameter_deg > 0.0, "the disc's diameter", diameter_deg, "above 0 degrees");
  constexpr int kSharp = 4;
  return {"disc",
          fmt::format("disc, {:g} deg wide", diameter_deg),
          size_deg,
          size_deg,
          [=](double x, double y) { return std::hypot(x, y) <= 0.5 * diameter_deg ? 1.0 : 0.0; },
          kSharp};
}

Stimulus grating_stimulus(double frequency_cpd, double orientation_deg, double size_deg) {
  const double angle = orientation_deg * std::numbers::pi / 180.0;
  return {"grating",
          fmt::format("sine grating, {:g} cpd", frequency_cpd),
          size_deg,
          size_deg,
          [=](double x, double y) {
            const double u = x * std::cos(angle) + y * std::sin(angle);
            return std::cos(2.0 * std::numbers::pi * frequency_cpd * u);
          },
          1};
}

StimulusPair pedestal_pair(const Stimulus& pattern, double pedestal, double increment,
                           double mean_cd_m2, double pixels_per_degree) {
  require(increment >= 0.0, "increment", increment, "0 and above");
  return {stimulus_image(pattern, pedestal, mean_cd_m2, pixels_per_degree),
          stimulus_image(pattern, pedestal + increment, mean_cd_m2, pixels_per_degree)};
}

StimulusPair masked_pair(const Stimulus& target, double target_contrast, const Stimulus& masker,
                         double masker_contrast, double mean_cd_m2, double pixels_per_degree) {
  StimulusPair pair;
  pair.reference = stimulus_image(masker, masker_contrast, mean_cd_m2, pixels_per_degree);
  const Image alone = stimulus_image(target, target_contrast, mean_cd_m2, pixels_per_degree);
  if (!alone.has_size_of(pair.reference)) {
    throw base::InputError(fmt::format(
        "target and masker are {}x{} and {}x{} pixels; accepted: equal sizes", alone.width_px,
        alone.height_px, pair.reference.width_px, pair.reference.height_px));
  }
  pair.test = added(pair.reference, alone, mean_cd_m2);
  return pair;
}

}  // namespace perception
