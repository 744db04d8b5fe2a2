// Reinhard, Stark, Shirley, Ferwerda 2002, "Photographic Tone Reproduction for Digital Images",
// doi:10.1145/566654.566575.

#include "perception/tone_mapping.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "perception/color_conversion.h"
#include "perception/display_model.h"

namespace perception {
namespace {

constexpr std::size_t kGrainPixels = 1 << 12;
constexpr int kReinhardPoints = 256;

void require_light(const Image& light) {
  if (light.encoding == Encoding::luminance_cd_m2) return;
  throw base::InputError(
      fmt::format("tone curves are of light, but the image is {}; accepted: "
                  "luminance_cd_m2",
                  to_string(light.encoding)));
}

double luminance_of(const float* pixel, std::size_t channels) {
  if (channels == 1) return static_cast<double>(pixel[0]);
  return static_cast<double>(kRec709Luma[0]) * static_cast<double>(pixel[0]) +
         static_cast<double>(kRec709Luma[1]) * static_cast<double>(pixel[1]) +
         static_cast<double>(kRec709Luma[2]) * static_cast<double>(pixel[2]);
}

/// Largest luminance and log average of the pixels that count.
struct LightSummary {
  double largest_cd_m2 = 0.0;
  double log_average_cd_m2 = 0.0;
};

/// Eq. 1: the log average exp(mean log(delta + L)). Differs from the paper: no delta; instead of
/// shifting all luminances, black pixels do not count.
LightSummary summary_of(const Image& light) {
  constexpr double kDarkest_cd_m2 = 1e-4;
  const Image pixels = light.channel_count() == 1 ? light : rgb_of(light);
  const std::size_t channels = pixels.channels.size();
  LightSummary summary;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels.pixel_count(); ++i) {
    const double luminance = luminance_of(pixels.pixels.data() + i * channels, channels);
    if (!std::isfinite(luminance) || luminance < kDarkest_cd_m2) continue;
    summary.largest_cd_m2 = std::max(summary.largest_cd_m2, luminance);
    sum += std::log(luminance);
    ++count;
  }
  if (count == 0) {
    throw base::InputError(
        "no pixel of the image has light to adapt to; accepted: at least one of 0.0001 cd/m2");
  }
  summary.log_average_cd_m2 = std::exp(sum / static_cast<double>(count));
  return summary;
}

const char* aces_hdr_view(double peak_cd_m2) {
  if (peak_cd_m2 >= 4000.0) return "ACES HDR 4000";
  return peak_cd_m2 >= 2000.0 ? "ACES HDR 2000" : "ACES HDR 1000";
}

Image exposed(Image image, double exposure_ev) {
  const auto gain = static_cast<float>(std::exp2(exposure_ev));
  for (float& value : image.pixels) value *= gain;
  return image;
}

}  // namespace

DisplayRange display_range(const ViewingConditions& viewing) {
  const double reflected = viewing.ambient_lux * viewing.screen_reflectance / std::numbers::pi;
  return {viewing.black_cd_m2 + reflected, viewing.peak_cd_m2 + reflected};
}

ToneCurve::ToneCurve(std::vector<Point> points) : points_(std::move(points)) {
  bool is_fine = !points_.empty();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    is_fine = is_fine && points_[i].world_cd_m2 > 0.0 && points_[i].display_cd_m2 > 0.0;
    if (i > 0) {
      is_fine = is_fine && points_[i].world_cd_m2 > points_[i - 1].world_cd_m2 &&
                points_[i].display_cd_m2 >= points_[i - 1].display_cd_m2;
    }
    log_world_.push_back(std::log(points_[i].world_cd_m2));
    log_display_.push_back(std::log(points_[i].display_cd_m2));
  }
  if (!is_fine) {
    throw base::InputError(
        "the points of a tone curve do not rise; accepted: at least one point, luminances above 0, "
        "world luminance rising, display luminance not falling");
  }
}

std::size_t ToneCurve::piece_at(double log_world) const {
  const auto next = std::upper_bound(log_world_.begin(), log_world_.end(), log_world);
  return static_cast<std::size_t>(next - log_world_.begin()) - 1;
}

double ToneCurve::operator()(double world_cd_m2) const {
  if (std::isnan(world_cd_m2)) return world_cd_m2;
  if (world_cd_m2 <= points_.front().world_cd_m2) return points_.front().display_cd_m2;
  if (world_cd_m2 >= points_.back().world_cd_m2) return points_.back().display_cd_m2;
  const double log_world = std::log(world_cd_m2);
  const std::size_t i = std::min(piece_at(log_world), points_.size() - 2);
  const double t = (log_world - log_world_[i]) / (log_world_[i + 1] - log_world_[i]);
  return std::exp(log_display_[i] + t * (log_display_[i + 1] - log_display_[i]));
}

double ToneCurve::slope(double world_cd_m2) const {
  if (std::isnan(world_cd_m2)) return world_cd_m2;
  if (world_cd_m2 < points_.front().world_cd_m2 || world_cd_m2 >= points_.back().world_cd_m2) {
    return 0.0;
  }
  const std::size_t i = std::min(piece_at(std::log(world_cd_m2)), points_.size() - 2);
  const double exponent =
      (log_display_[i + 1] - log_display_[i]) / (log_world_[i + 1] - log_world_[i]);
  return exponent * (*this)(world_cd_m2) / world_cd_m2;
}

ToneCurve linear_tone_curve(const DisplayRange& range, double scale) {
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    throw base::InputError(fmt::format("a tone curve's scale is {}; accepted: above 0", scale));
  }
  return ToneCurve({{range.black_cd_m2 / scale, range.black_cd_m2},
                    {range.peak_cd_m2 / scale, range.peak_cd_m2}});
}

/// Eq. 2, L = (a / L_average) L_w, and Eq. 4, L_d = L (1 + L / L_white^2) / (1 + L), from 0 to 1,
/// which is the display's range.
ToneCurve photographic_curve(const Image& light, const ViewingConditions& viewing,
                             const ReinhardSettings& settings) {
  require_light(light);
  if (!(settings.key > 0.0)) {
    throw base::InputError(fmt::format("the key is {}; accepted: above 0", settings.key));
  }
  if (!(settings.white_cd_m2 >= 0.0)) {
    throw base::InputError(
        fmt::format("white_cd_m2 is {}; accepted: 0 and above", settings.white_cd_m2));
  }
  const LightSummary summary = summary_of(light);
  const DisplayRange range = display_range(viewing);
  const double scale = settings.key / summary.log_average_cd_m2;
  const double white =
      scale * (settings.white_cd_m2 > 0.0 ? settings.white_cd_m2 : summary.largest_cd_m2);
  std::vector<ToneCurve::Point> points;
  for (int i = 0; i <= kReinhardPoints; ++i) {
    // Six decades below white.
    const double l = white * std::pow(10.0, 6.0 * (static_cast<double>(i) / kReinhardPoints - 1.0));
    const double shown = l * (1.0 + l / (white * white)) / (1.0 + l);
    points.push_back(
        {l / scale, range.black_cd_m2 + (range.peak_cd_m2 - range.black_cd_m2) * shown});
  }
  return ToneCurve(std::move(points));
}

Image tone_mapped(const Image& light, const ToneCurve& curve) {
  require_light(light);
  Image result = light.channel_count() == 1 ? light : rgb_of(light);
  const std::size_t channels = result.channels.size();
  base::parallel_for(result.pixel_count(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      float* pixel = result.pixels.data() + i * channels;
      const double world = luminance_of(pixel, channels);
      if (!std::isfinite(world)) continue;
      const double display = curve(world);
      for (std::size_t c = 0; c < channels; ++c) {
        // Black has no colour to scale: it is shown as the display's grey black.
        pixel[c] = static_cast<float>(
            world > 0.0 ? static_cast<double>(pixel[c]) * (display / world) : display);
      }
    }
  });
  return result;
}

Image aces_tone_mapped(const Image& scene_linear, const ColorManagement& colors,
                       const ViewingConditions& viewing) {
  if (scene_linear.encoding != Encoding::scene_linear) {
    throw base::InputError(
        fmt::format("ACES output transforms are of scene_linear images; this "
                    "one is {}",
                    to_string(scene_linear.encoding)));
  }
  const bool is_sdr = viewing.transfer == DisplayTransfer::srgb;
  if (!is_sdr && viewing.transfer != DisplayTransfer::pq) {
    throw base::InputError(
        fmt::format("no ACES output transform for the display transfer \"{}\"; accepted: srgb, pq",
                    to_string(viewing.transfer)));
  }
  const Image shown =
      colors.view(exposed(scene_linear, viewing.exposure_ev), is_sdr ? "sRGB" : "PQ",
                  is_sdr ? "ACES SDR" : aces_hdr_view(viewing.peak_cd_m2));
  return to_display_light(shown, viewing);
}

}  // namespace perception
