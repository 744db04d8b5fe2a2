// SDR and HDR displays as in Mantiuk et al. 2024, "ColorVideoVDP: A visual difference predictor for
// image, video and display distortions", and its reference code.

#include "perception/display_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "perception/color_conversion.h"

namespace perception {
namespace {

using Rgb = std::array<double, 3>;

constexpr std::size_t kGrainPixels = 4096;

/// Least light of the PQ and linear HDR models, cd/m2 (ColorVideoVDP, display model).
constexpr double kHdrFloor_cd_m2 = 0.005;

/// BT.2020 to BT.709, computed from the primaries of ITU-R BT.2020 and BT.709 and their common
/// white.
constexpr std::array<Rgb, 3> kRec709FromRec2020{{
    {1.6604910021, -0.5876411388, -0.0728498633},
    {-0.1245504745, 1.1328998971, -0.0083494226},
    {-0.0181507634, -0.1005788980, 1.1187296614},
}};

/// SMPTE ST 2084:2014, EOTF: signal to cd/m2.
double pq_eotf(double signal) {
  constexpr double kM1 = 2610.0 / 16384.0;
  constexpr double kM2 = 2523.0 / 4096.0 * 128.0;
  constexpr double kC1 = 3424.0 / 4096.0;
  constexpr double kC2 = 2413.0 / 4096.0 * 32.0;
  constexpr double kC3 = 2392.0 / 4096.0 * 32.0;
  constexpr double kPeak_cd_m2 = 10000.0;
  const double root = std::pow(signal, 1.0 / kM2);
  return kPeak_cd_m2 * std::pow(std::max(root - kC1, 0.0) / (kC2 - kC3 * root), 1.0 / kM1);
}

/// ITU-R BT.2100, HLG inverse OETF: signal to scene light in [0, 1].
double hlg_scene_light(double signal) {
  constexpr double kA = 0.17883277;
  constexpr double kB = 1.0 - 4.0 * kA;
  const double c = 0.5 - kA * std::log(4.0 * kA);
  if (signal <= 0.5) return signal * signal / 3.0;
  return (std::exp((signal - c) / kA) + kB) / 12.0;
}

/// ITU-R BT.2100, HLG system gamma, with the surround term of ColorVideoVDP's reference code.
/// Up to 1000 cd/m2 it is 1.2. Differs from the source: the surround term counts from 5 lux on,
/// since it has no limit towards darkness.
double hlg_system_gamma(const ViewingConditions& viewing) {
  constexpr double kNominalPeak_cd_m2 = 1000.0;
  constexpr double kNominalSurround_lux = 5.0;
  if (viewing.peak_cd_m2 <= kNominalPeak_cd_m2) return 1.2;
  const double surround = std::max(viewing.ambient_lux, kNominalSurround_lux);
  return 1.2 + 0.42 * std::log10(viewing.peak_cd_m2 / kNominalPeak_cd_m2) -
         0.07623 * std::log10(surround / kNominalSurround_lux);
}

/// ITU-R BT.2100, HLG OOTF: F = peak Y_S^(gamma - 1) E, with the luma of BT.2020.
Rgb hlg_light(const Rgb& signal, const ViewingConditions& viewing) {
  Rgb scene{};
  std::transform(signal.begin(), signal.end(), scene.begin(), hlg_scene_light);
  const double luminance = 0.2627 * scene[0] + 0.6780 * scene[1] + 0.0593 * scene[2];
  if (luminance <= 0.0) return {viewing.black_cd_m2, viewing.black_cd_m2, viewing.black_cd_m2};
  const double gain = viewing.peak_cd_m2 * std::pow(luminance, hlg_system_gamma(viewing) - 1.0);
  for (double& value : scene) value = gain * value + viewing.black_cd_m2;
  return scene;
}

/// ITU-R BT.1886, Annex 1: L = a max(V + b, 0)^2.4, which includes the display's black.
double bt1886_light(double signal, const ViewingConditions& viewing) {
  constexpr double kGamma = 2.4;
  const double white = std::pow(viewing.peak_cd_m2, 1.0 / kGamma);
  const double black = std::pow(viewing.black_cd_m2, 1.0 / kGamma);
  return std::pow((white - black) * signal + black, kGamma);
}

Rgb display_light(const Rgb& signal, const ViewingConditions& viewing) {
  if (viewing.transfer == DisplayTransfer::hlg) return hlg_light(signal, viewing);
  Rgb light{};
  for (std::size_t c = 0; c < 3; ++c) {
    if (viewing.transfer == DisplayTransfer::srgb) {
      const double linear = srgb_decode(static_cast<float>(signal[c]));
      light[c] = (viewing.peak_cd_m2 - viewing.black_cd_m2) * linear + viewing.black_cd_m2;
    } else if (viewing.transfer == DisplayTransfer::bt1886) {
      light[c] = bt1886_light(signal[c], viewing);
    } else {
      light[c] =
          std::clamp(pq_eotf(signal[c]), kHdrFloor_cd_m2, viewing.peak_cd_m2) + viewing.black_cd_m2;
    }
  }
  return light;
}

Rgb rec709_from_rec2020(const Rgb& light) {
  Rgb result{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t c = 0; c < 3; ++c) result[row] += kRec709FromRec2020[row][c] * light[c];
  }
  return result;
}

/// Light of one pixel that is display-encoded; any non-finite value makes it stay as it is.
Rgb pixel_light(const Rgb& signal, const ViewingConditions& viewing, bool is_color) {
  const auto is_finite = [](double v) { return std::isfinite(v); };
  if (!std::all_of(signal.begin(), signal.end(), is_finite)) return signal;
  Rgb clipped = signal;
  for (double& value : clipped) value = std::clamp(value, 0.0, 1.0);
  Rgb light = display_light(clipped, viewing);
  const bool is_wide =
      viewing.transfer == DisplayTransfer::pq || viewing.transfer == DisplayTransfer::hlg;
  if (is_wide && is_color) light = rec709_from_rec2020(light);
  const double reflected = viewing.ambient_lux * viewing.screen_reflectance / std::numbers::pi;
  for (double& value : light) value += reflected;
  return light;
}

/// Light of the signals that files with 8 bits hold, for displays whose channels do not depend on
/// each other: the same values as pixel_light gives, looked up.
class LevelLights {
 public:
  explicit LevelLights(const ViewingConditions& viewing) {
    for (int level = 0; level <= kLargestLevel; ++level) {
      const float signal = static_cast<float>(level) / kLargestLevel;
      const double light =
          pixel_light({double{signal}, double{signal}, double{signal}}, viewing, false)[0];
      lights_[static_cast<std::size_t>(level)] = {signal, static_cast<float>(light)};
    }
  }

  static bool is_possible(const ViewingConditions& viewing) {
    return viewing.transfer == DisplayTransfer::srgb || viewing.transfer == DisplayTransfer::bt1886;
  }

  /// Turns signals into light. @return false, with nothing done, unless all are such levels
  bool apply(std::span<float> signals) const {
    for (const float signal : signals) {
      if (!(signal >= 0.0F && signal <= 1.0F) || of(signal).signal != signal) return false;
    }
    for (float& signal : signals) signal = of(signal).light;
    return true;
  }

 private:
  static constexpr int kLargestLevel = 255;
  struct Level {
    float signal;
    float light;
  };
  const Level& of(float signal) const {
    return lights_[static_cast<std::size_t>(signal * kLargestLevel + 0.5F)];
  }
  std::array<Level, kLargestLevel + 1> lights_;
};

Image light_of_scene(Image image, const ViewingConditions& viewing) {
  const double gain = std::exp2(viewing.exposure_ev) * viewing.luminance_scale_cd_m2;
  const double low = std::max(kHdrFloor_cd_m2, viewing.black_cd_m2);
  const double reflected = viewing.ambient_lux * viewing.screen_reflectance / std::numbers::pi;
  base::parallel_for(image.pixels.size(), 3 * kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      float& value = image.pixels[i];
      if (!std::isfinite(value)) continue;
      value = static_cast<float>(
          std::clamp(gain * static_cast<double>(value), low, viewing.peak_cd_m2) + reflected);
    }
  });
  return image;
}

Image light_of_signal(Image image, const ViewingConditions& viewing) {
  if (viewing.transfer == DisplayTransfer::linear_hdr) {
    throw base::InputError(
        "a display-encoded image cannot be shown with the display transfer \"linear_hdr\"; "
        "accepted "
        "for it: srgb, bt1886, pq, hlg");
  }
  const std::size_t channels = image.channels.size();
  std::optional<LevelLights> levels;
  if (LevelLights::is_possible(viewing)) levels.emplace(viewing);
  base::parallel_for(image.pixel_count(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      float* pixel = image.pixels.data() + i * channels;
      if (levels && levels->apply({pixel, channels})) continue;
      const Rgb signal{pixel[0], pixel[channels == 3 ? 1 : 0], pixel[channels == 3 ? 2 : 0]};
      const Rgb light = pixel_light(signal, viewing, channels == 3);
      for (std::size_t c = 0; c < channels; ++c) pixel[c] = static_cast<float>(light[c]);
    }
  });
  return image;
}

}  // namespace

Image to_display_light(const Image& image, const ViewingConditions& viewing) {
  if (image.encoding == Encoding::luminance_cd_m2) return image;
  Image colors = image.channel_count() == 1 ? image : rgb_of(image);
  Image light = image.encoding == Encoding::scene_linear
                    ? light_of_scene(std::move(colors), viewing)
                    : light_of_signal(std::move(colors), viewing);
  light.encoding = Encoding::luminance_cd_m2;
  if (light.channel_count() == 1) light.channels = {"Y"};
  return light;
}

Image to_display_encoded(const Image& image, double exposure_ev) {
  if (image.encoding == Encoding::display) return rgb_of(image);
  if (image.encoding == Encoding::luminance_cd_m2) {
    throw base::InputError(
        "an image in luminance_cd_m2 has no display signal of its own; accepted: scene_linear, "
        "display");
  }
  Image encoded = rgb_of(image);
  encoded.encoding = Encoding::display;
  const double gain = std::exp2(exposure_ev);
  base::parallel_for(encoded.pixels.size(), 3 * kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      float& value = encoded.pixels[i];
      if (!std::isfinite(value)) continue;
      value =
          srgb_encode(static_cast<float>(std::clamp(gain * static_cast<double>(value), 0.0, 1.0)));
    }
  });
  return encoded;
}

}  // namespace perception
