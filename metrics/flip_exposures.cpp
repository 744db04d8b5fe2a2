#include "metrics/flip_exposures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "metrics/score_pooling.h"
#include "perception/base/errors.h"
#include "perception/color_conversion.h"

namespace metrics {
namespace {

/// The display value to which the brightest and the median pixel are brought (Andersson et al.
/// 2021, Sec. 3).
constexpr double kAnchorValue = 0.85;
/// Inputs above are cut: the rational curves are above 1, so bounded to 1, long before, and squares
/// stay finite.
constexpr float kLargestInput = 1e6F;

float luminance(const float* rgb) {
  constexpr auto kWeights = perception::kRec709Luma;
  return kWeights[0] * rgb[0] + kWeights[1] * rgb[1] + kWeights[2] * rgb[2];
}

struct LuminanceRange {
  double maximum = 0.0;
  double median = 0.0;           ///< the upper one for even counts
  double positive_median = 0.0;  ///< 0 if nothing is positive
};

double upper_median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// Of the pixels that take part, of which there is at least one.
LuminanceRange luminance_range(const Image& image, const Image* mask) {
  std::vector<float> values;
  values.reserve(image.pixel_count());
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    if (takes_part(mask, i)) values.push_back(luminance(&image.pixels[3 * i]));
  }
  assert(!values.empty());
  LuminanceRange range;
  range.maximum = static_cast<double>(*std::max_element(values.begin(), values.end()));
  range.median = upper_median(values);
  range.positive_median = range.median;
  if (range.median <= 0.0) {
    std::erase_if(values, [](float value) { return value <= 0.0F; });
    range.positive_median = values.empty() ? 0.0 : upper_median(values);
  }
  return range;
}

/// Start and stop from the luminances (Andersson et al. 2021, Sec. 3); the published rule has no
/// exposure for a median of 0, so it falls back to the median of what is lit.
ExposureRange automatic_range(const Image& reference, const Image& test, const Image* mask,
                              double anchor) {
  ExposureRange range;
  LuminanceRange light = luminance_range(reference, mask);
  if (light.median <= 0.0) range.fallback = ExposureFallback::positive_reference_median;
  if (light.positive_median <= 0.0) {
    light = luminance_range(test, mask);
    range.fallback = ExposureFallback::positive_test_median;
  }
  if (light.positive_median <= 0.0) {
    range.fallback = ExposureFallback::black;
    return range;
  }
  const bool is_lit = range.fallback == ExposureFallback::none;
  range.start_ev = std::log2(anchor / light.maximum);
  range.stop_ev = std::log2(anchor / (is_lit ? light.median : light.positive_median));
  return range;
}

/// The rational curves act on each channel.
void map_row_by_curve(const ToneCurve& curve, float gain, const float* rgb, int width_px,
                      const RowOfThree& out) {
  float k[6];
  for (std::size_t i = 0; i < 6; ++i) k[i] = static_cast<float>(curve.k[i]);
  float* const channels[3] = {out.first, out.second, out.third};
  for (int c = 0; c < 3; ++c) {
    float* __restrict mapped = channels[c];
    for (int i = 0; i < width_px; ++i) {
      const float exposed = rgb[3 * i + c] * gain;
      const float positive = exposed < 0.0F ? 0.0F : exposed;
      const float x = positive > kLargestInput ? kLargestInput : positive;
      const float y = ((k[0] * x + k[1]) * x + k[2]) / ((k[3] * x + k[4]) * x + k[5]);
      const float lower = y < 0.0F ? 0.0F : y;
      mapped[i] = lower > 1.0F ? 1.0F : lower;
    }
  }
}

/// Reinhard's curve scales all channels by 1 / (1 + Y).
void map_row_by_luminance(float gain, const float* rgb, int width_px, const RowOfThree& out) {
  float* const channels[3] = {out.first, out.second, out.third};
  for (int i = 0; i < width_px; ++i) {
    float exposed[3];
    for (int c = 0; c < 3; ++c) exposed[c] = std::clamp(rgb[3 * i + c] * gain, 0.0F, 1e30F);
    const float scale = 1.0F / (1.0F + luminance(exposed));
    for (int c = 0; c < 3; ++c) channels[c][i] = std::min(exposed[c] * scale, 1.0F);
  }
}

}  // namespace

ToneCurve tone_curve(ToneMapper mapper) {
  switch (mapper) {
    case ToneMapper::aces:
      return {{0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14}};
    case ToneMapper::hable:
      return {{0.231683, 0.013791, 0.0, 0.18, 0.3, 0.018}};
    case ToneMapper::reinhard:
      break;
  }
  return {{0.0, 1.0, 0.0, 0.0, 1.0, 1.0}};
}

double inverse_tone_curve(const ToneCurve& curve, double display_value) {
  const double a = curve.k[0] - display_value * curve.k[3];
  const double b = curve.k[1] - display_value * curve.k[4];
  const double c = curve.k[2] - display_value * curve.k[5];
  if (a == 0.0) return -c / b;
  // The curve rises from c / k[5] <= 0, so the larger root is the one on the branch x >= 0.
  const double root = std::sqrt(b * b - 4.0 * a * c);
  return std::max((-b + root) / (2.0 * a), (-b - root) / (2.0 * a));
}

double ExposureRange::exposure_ev(int index) const {
  if (count < 2) return start_ev;
  return start_ev + (stop_ev - start_ev) * index / (count - 1);
}

std::optional<ReferenceExposures> reference_exposures(const Image& reference, ToneMapper mapper,
                                                      const Image* mask) {
  const LuminanceRange light = luminance_range(reference, mask);
  if (light.positive_median <= 0.0) return std::nullopt;
  const double anchor = inverse_tone_curve(tone_curve(mapper), kAnchorValue);
  return ReferenceExposures{std::log2(anchor / light.maximum),
                            std::log2(anchor / light.positive_median)};
}

ExposureRange choose_exposures(const Image& reference, const Image& test, ToneMapper mapper,
                               const ExposureChoice& choice, const Image* mask) {
  ExposureRange range;
  if (!choice.start_ev || !choice.stop_ev) {
    range = automatic_range(reference, test, mask,
                            inverse_tone_curve(tone_curve(mapper), kAnchorValue));
  }
  range.start_ev = choice.start_ev.value_or(range.start_ev);
  range.stop_ev = choice.stop_ev.value_or(range.stop_ev);
  if (range.start_ev > range.stop_ev) {
    throw base::InputError(fmt::format(
        "metric \"flip\": start_exposure {:.6g}{} is above stop_exposure {:.6g}{}; accepted: a "
        "start at or below the stop",
        range.start_ev, choice.start_ev ? "" : " (automatic)", range.stop_ev,
        choice.stop_ev ? "" : " (automatic)"));
  }
  range.count = choice.count > 0
                    ? choice.count
                    : std::max(2, static_cast<int>(std::ceil(range.stop_ev - range.start_ev)));
  return range;
}

void tone_map_row(ToneMapper mapper, double exposure_ev, const float* rgb, int width_px,
                  const RowOfThree& out) {
  const auto gain = static_cast<float>(std::exp2(exposure_ev));
  if (mapper == ToneMapper::reinhard) return map_row_by_luminance(gain, rgb, width_px, out);
  map_row_by_curve(tone_curve(mapper), gain, rgb, width_px, out);
}

}  // namespace metrics
