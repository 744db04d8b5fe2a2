// Ramasubramanian, Pattanaik, Greenberg 1999, "A Perceptually Based Physical Error Metric for
// Realistic Image Synthesis", doi:10.1145/311535.311543: the threshold is the product of a part
// that depends on luminance (TVI) and a part that depends on space (F, see visual_masking.cpp).

#include "perception/threshold_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "perception/base/parallel.h"
#include "perception/luminance_input.h"
#include "perception/tabulated_curve.h"

namespace perception {
namespace {

constexpr std::size_t kGrainPixels = 1 << 14;

/// Least luminance the eye is taken to adapt to, cd/m2.
constexpr float kDarkestAdaptation_cd_m2 = 1e-5F;

TabulatedCurve tabulated_tvi(const ThresholdSettings& settings) {
  return TabulatedCurve([curve = settings.curve, scale = settings.threshold_scale](double l) {
    return scale * threshold_cd_m2(curve, l);
  });
}

void check_viewing(const ViewingConditions& viewing) {
  if (viewing.pixels_per_degree > 0.0 && std::isfinite(viewing.pixels_per_degree)) return;
  throw base::InputError(
      fmt::format("pixels per degree are {}; accepted: above 0", viewing.pixels_per_degree));
}

LuminanceInput checked_input(const Image& light, const ViewingConditions& viewing,
                             const ThresholdSettings& settings) {
  check(settings);
  check_viewing(viewing);
  return luminance_input(light);
}

void set_nan(Image& map, const std::vector<std::size_t>& indices) {
  for (const std::size_t i : indices) map.pixels[i] = std::numeric_limits<float>::quiet_NaN();
}

void mark_non_finite(ThresholdMap& map, const std::vector<std::size_t>& indices) {
  set_nan(map.adaptation_cd_m2, indices);
  set_nan(map.tvi_cd_m2, indices);
  set_nan(map.elevation, indices);
  set_nan(map.threshold_cd_m2, indices);
  for (BandElevation& band : map.bands) set_nan(band.elevation, indices);
  for (ArtefactElevation& target : map.targets) set_nan(target.elevation, indices);
}

/// Fills tvi and threshold from adaptation and elevation.
void apply_tvi(ThresholdMap& map, const ThresholdSettings& settings) {
  const TabulatedCurve tvi = tabulated_tvi(settings);
  const Image& like = map.elevation;
  map.tvi_cd_m2 = make_gray_image(like.width_px, like.height_px, "tvi", like.encoding);
  map.threshold_cd_m2 = make_gray_image(like.width_px, like.height_px, "threshold", like.encoding);
  base::parallel_for(like.pixels.size(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      float& adaptation = map.adaptation_cd_m2.pixels[i];
      adaptation = std::max(adaptation, kDarkestAdaptation_cd_m2);
      map.tvi_cd_m2.pixels[i] = tvi(adaptation);
      map.threshold_cd_m2.pixels[i] = map.tvi_cd_m2.pixels[i] * map.elevation.pixels[i];
    }
  });
}

ThresholdMap map_of(LocalContrasts contrasts, const ThresholdSettings& settings) {
  ThresholdMap map;
  map.elevation = elevation_map(contrasts, settings.masking);
  if (settings.keeps_bands) {
    for (std::size_t b = 0; b < contrasts.bands.size(); ++b) {
      const BandContrast& band = contrasts.bands[b];
      map.bands.push_back({band.frequency_cpd, band.orientation_deg,
                           band_elevation_map(contrasts, b, settings.masking)});
    }
  }
  if (!settings.targets.empty()) {
    const TargetElevation elevation(contrasts, settings.masking);
    for (const MaskingTarget& target : settings.targets) {
      map.targets.push_back({target, elevation.unmasked(target), elevation.map(target)});
    }
  }
  map.adaptation_cd_m2 = std::move(contrasts.adaptation_cd_m2);
  apply_tvi(map, settings);
  return map;
}

}  // namespace

ThresholdSettings threshold_profile(std::string_view name, const base::Place& place) {
  // The mean misfit of thresholds in suites/catalog/psychophysics/calibration.yaml, 14 to 17 dB.
  constexpr double kCalibratedScale = 0.2;
  ThresholdSettings settings;
  settings.masking = masking_profile(name, place);
  if (base::is_same_name(name, "rama99_calibrated")) settings.threshold_scale = kCalibratedScale;
  return settings;
}

void check(const ThresholdSettings& settings) {
  check(settings.masking);
  if (!(settings.threshold_scale > 0.0) || !std::isfinite(settings.threshold_scale)) {
    throw base::InputError(
        fmt::format("threshold_scale is {}; accepted: above 0", settings.threshold_scale));
  }
}

ThresholdMap threshold_map(const Image& light, const ViewingConditions& viewing,
                           const ThresholdSettings& settings) {
  const LuminanceInput input = checked_input(light, viewing, settings);
  ThresholdMap map = map_of(
      local_contrasts(input.luminance, viewing.pixels_per_degree, settings.masking), settings);
  map.non_finite = input.non_finite;
  map.negative_pixels = input.negative_pixels;
  mark_non_finite(map, input.non_finite_indices);
  return map;
}

ThresholdMap threshold_map(const Image& light_a, const Image& light_b,
                           const ViewingConditions& viewing, const ThresholdSettings& settings) {
  if (!light_a.has_size_of(light_b)) {
    throw base::InputError(
        fmt::format("the images are {}x{} and {}x{} pixels; accepted: equal sizes",
                    light_a.width_px, light_a.height_px, light_b.width_px, light_b.height_px));
  }
  const LuminanceInput a = checked_input(light_a, viewing, settings);
  const LuminanceInput b = checked_input(light_b, viewing, settings);
  const double ppd = viewing.pixels_per_degree;
  ThresholdMap map =
      map_of(joined(local_contrasts(a.luminance, ppd, settings.masking),
                    local_contrasts(b.luminance, ppd, settings.masking), settings.masking.pair),
             settings);
  map.negative_pixels = a.negative_pixels + b.negative_pixels;
  mark_non_finite(map, a.non_finite_indices);
  mark_non_finite(map, b.non_finite_indices);
  map.non_finite = count_non_finite(map.threshold_cd_m2);
  return map;
}

double detection_probability(double thresholds, OneThreshold meaning) {
  constexpr double kSlope = 3.5;
  const double gain = meaning == OneThreshold::half_seen ? std::numbers::ln2 : 1.0;
  return -std::expm1(-gain * std::pow(std::abs(thresholds), kSlope));
}

struct ThresholdField::State {
  State(LocalContrasts kept_contrasts, const ThresholdSettings& settings,
        Image elevation_of_preview, double mean_luminance, bool keeps_bands)
      : contrasts(std::move(kept_contrasts)),
        elevation(std::move(elevation_of_preview)),
        tvi(tabulated_tvi(settings)),
        mean_threshold_cd_m2(settings.threshold_scale *
                             perception::threshold_cd_m2(settings.curve, mean_luminance)) {
    if (keeps_bands) {
      target.emplace(contrasts, settings.masking);
    } else {
      contrasts.bands.clear();
    }
  }

  double tvi_at(double adaptation_cd_m2) const {
    return static_cast<double>(
        tvi(std::max(static_cast<float>(adaptation_cd_m2), kDarkestAdaptation_cd_m2)));
  }

  LocalContrasts contrasts;
  Image elevation;
  TabulatedCurve tvi;
  double mean_threshold_cd_m2;
  std::optional<TargetElevation> target;
};

namespace {

/// Bilinear between pixel centres, the border's value beyond.
double sampled(const Image& map, double x_px, double y_px) {
  assert(std::isfinite(x_px) && std::isfinite(y_px));
  const double x = std::clamp(x_px, 0.0, static_cast<double>(map.width_px - 1));
  const double y = std::clamp(y_px, 0.0, static_cast<double>(map.height_px - 1));
  const int x0 = std::min(static_cast<int>(x), std::max(map.width_px - 2, 0));
  const int y0 = std::min(static_cast<int>(y), std::max(map.height_px - 2, 0));
  const int x1 = std::min(x0 + 1, map.width_px - 1);
  const int y1 = std::min(y0 + 1, map.height_px - 1);
  const double u = x - x0;
  const double v = y - y0;
  const auto at = [&](int i, int j) { return static_cast<double>(map.at(i, j)); };
  return (1.0 - v) * ((1.0 - u) * at(x0, y0) + u * at(x1, y0)) +
         v * ((1.0 - u) * at(x0, y1) + u * at(x1, y1));
}

std::size_t nearest_pixel(const Image& map, double x_px, double y_px) {
  const double x = std::clamp(std::round(x_px), 0.0, static_cast<double>(map.width_px - 1));
  const double y = std::clamp(std::round(y_px), 0.0, static_cast<double>(map.height_px - 1));
  return map.offset(static_cast<int>(x), static_cast<int>(y));
}

double mean_of(const Image& image) {
  double sum = 0.0;
  for (int y = 0; y < image.height_px; ++y) {
    double row = 0.0;
    for (int x = 0; x < image.width_px; ++x) row += static_cast<double>(image.at(x, y));
    sum += row;
  }
  return sum / static_cast<double>(image.pixel_count());
}

}  // namespace

ThresholdField::ThresholdField(const Image& preview, const ViewingConditions& viewing,
                               const ThresholdSettings& settings, Keeps keeps) {
  const LuminanceInput input = checked_input(preview, viewing, settings);
  if (input.non_finite.pixels > 0) {
    throw base::InputError(fmt::format(
        "the preview has {} non-finite pixels, the first at {},{}; accepted: finite light",
        input.non_finite.pixels, input.non_finite.first_x_px, input.non_finite.first_y_px));
  }
  LocalContrasts contrasts =
      local_contrasts(input.luminance, viewing.pixels_per_degree, settings.masking);
  Image elevation = elevation_map(contrasts, settings.masking);
  state_ = std::make_unique<State>(std::move(contrasts), settings, std::move(elevation),
                                   mean_of(input.luminance), keeps == Keeps::bands);
}

ThresholdField::~ThresholdField() = default;
ThresholdField::ThresholdField(ThresholdField&&) noexcept = default;
ThresholdField& ThresholdField::operator=(ThresholdField&&) noexcept = default;

int ThresholdField::width_px() const { return state_->elevation.width_px; }
int ThresholdField::height_px() const { return state_->elevation.height_px; }

double ThresholdField::adaptation_cd_m2(double x_px, double y_px) const {
  return sampled(state_->contrasts.adaptation_cd_m2, x_px, y_px);
}

double ThresholdField::elevation(double x_px, double y_px) const {
  return sampled(state_->elevation, x_px, y_px);
}

double ThresholdField::threshold_cd_m2(double x_px, double y_px) const {
  return threshold_cd_m2(x_px, y_px, adaptation_cd_m2(x_px, y_px));
}

double ThresholdField::threshold_cd_m2(double x_px, double y_px, double adaptation_cd_m2) const {
  return state_->tvi_at(adaptation_cd_m2) * elevation(x_px, y_px);
}

double ThresholdField::threshold_cd_m2(double x_px, double y_px,
                                       const MaskingTarget& target) const {
  if (!state_->target) {
    throw base::InputError(
        "a masking target was asked of a threshold field without bands; accepted: fields that "
        "keep bands");
  }
  const std::size_t pixel = nearest_pixel(state_->elevation, x_px, y_px);
  return state_->tvi_at(adaptation_cd_m2(x_px, y_px)) * state_->target->at(pixel, target);
}

double ThresholdField::mean_threshold_cd_m2() const { return state_->mean_threshold_cd_m2; }

}  // namespace perception
