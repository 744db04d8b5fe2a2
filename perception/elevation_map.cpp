// Threshold elevation of whole images; sources in visual_masking.cpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "perception/base/parallel.h"
#include "perception/cortex_transform.h"
#include "perception/visual_masking.h"

namespace perception {
namespace {

constexpr std::size_t kGrainPixels = 1 << 12;
constexpr float kLeastContrast = 1e-5F;  ///< sum of contrasts to divide by (Yee's code)
constexpr double kLargestCsfElevation = 1e6;
constexpr double kOneOctave = 1.0;
constexpr double kOneFan_deg = 30.0;

double mask_sensitivity(const MaskingSettings& settings, double frequency_cpd, double luminance) {
  return settings.csf_gain * contrast_sensitivity(find_csf(settings.csf), frequency_cpd, luminance);
}

/// A channel with what its contrast is worth.
struct Channel {
  const float* contrast;
  float csf_elevation;
  float sensitivity;
  std::optional<TabulatedCurve> sensitivity_at;  ///< over adaptation, where it follows it
};

std::vector<Channel> channels_of(const LocalContrasts& contrasts, const MaskingSettings& settings) {
  std::vector<Channel> channels;
  for (const BandContrast& band : contrasts.bands) {
    const double f = band.frequency_cpd;
    Channel channel{band.contrast.pixels.data(), static_cast<float>(csf_elevation(settings, f)),
                    static_cast<float>(mask_sensitivity(settings, f, settings.csf_luminance_cd_m2)),
                    std::nullopt};
    if (settings.is_yee_adaptation) {
      channel.sensitivity_at.emplace(
          [&settings, f](double luminance) { return mask_sensitivity(settings, f, luminance); });
    }
    channels.push_back(std::move(channel));
  }
  return channels;
}

TabulatedCurve tabulated(const MaskingCurve& curve) {
  return TabulatedCurve([curve](double m) { return threshold_elevation(m, curve); });
}

/// F_mask of a channel at a pixel.
inline float mask_elevation(const Channel& channel, std::size_t i, const float* adaptation,
                            const TabulatedCurve& curve) {
  constexpr float kDarkest_cd_m2 = 1e-5F;
  const float sensitivity = channel.sensitivity_at
                                ? (*channel.sensitivity_at)(std::max(adaptation[i], kDarkest_cd_m2))
                                : channel.sensitivity;
  return curve(channel.contrast[i] * sensitivity);
}

/// Sums over the channels at one pixel.
struct Sums {
  float contrast = 0.0F;
  float csf = 0.0F;   ///< C F_csf
  float mask = 0.0F;  ///< C F_mask
  float both = 0.0F;  ///< C F_csf F_mask
};

Sums summed(const std::vector<Channel>& channels, std::size_t i, const float* adaptation,
            const TabulatedCurve& curve) {
  Sums sums;
  for (const Channel& channel : channels) {
    const float contrast = channel.contrast[i];
    const float masked = contrast * mask_elevation(channel, i, adaptation, curve);
    sums.contrast += contrast;
    sums.csf += contrast * channel.csf_elevation;
    sums.mask += masked;
    sums.both += masked * channel.csf_elevation;
  }
  return sums;
}

float elevation_of(const Sums& sums, const MaskingSettings& settings) {
  const auto neutral = static_cast<float>(settings.neutral_contrast);
  const float contrast = std::max(sums.contrast + neutral, kLeastContrast);
  const float elevation =
      settings.combination == MaskingCombination::joint
          ? (sums.both + neutral) / contrast
          : (sums.csf + neutral) / contrast * ((sums.mask + neutral) / contrast);
  return std::clamp(elevation, 1.0F, static_cast<float>(settings.largest_elevation));
}

/// How far a channel takes part in masking a target, 0 to 1.
double channel_weight(const BandContrast& band, const MaskingTarget& target) {
  const double octaves = std::abs(std::log2(band.frequency_cpd / target.frequency_cpd));
  if (octaves >= kOneOctave) return 0.0;
  const double weight = 1.0 - octaves / kOneOctave;
  if (!target.orientation_deg) return weight;
  const double distance =
      orientation_difference_deg(*band.orientation_deg, *target.orientation_deg);
  if (distance >= kOneFan_deg) return 0.0;
  return weight * 0.5 * (1.0 + std::cos(std::numbers::pi * distance / kOneFan_deg));
}

}  // namespace

double csf_elevation(const MaskingSettings& settings, double frequency_cpd) {
  const CsfInfo& csf = find_csf(settings.csf);
  const double luminance = settings.csf_luminance_cd_m2;
  const double sensitivity = contrast_sensitivity(csf, frequency_cpd, luminance);
  if (std::isnan(sensitivity)) return sensitivity;
  const double best = csf_peak(csf, luminance).sensitivity;
  return std::clamp(best / sensitivity, 1.0, kLargestCsfElevation);
}

Image elevation_map(const LocalContrasts& contrasts, const MaskingSettings& settings) {
  const Image& like = contrasts.adaptation_cd_m2;
  Image map = make_gray_image(like.width_px, like.height_px, "elevation", like.encoding);
  const std::vector<Channel> channels = channels_of(contrasts, settings);
  const TabulatedCurve curve = tabulated(settings.curve);
  base::parallel_for(map.pixels.size(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      map.pixels[i] = elevation_of(summed(channels, i, like.pixels.data(), curve), settings);
    }
  });
  return map;
}

Image band_elevation_map(const LocalContrasts& contrasts, std::size_t band,
                         const MaskingSettings& settings) {
  const Image& like = contrasts.adaptation_cd_m2;
  Image map = make_gray_image(like.width_px, like.height_px, "elevation", like.encoding);
  const std::vector<Channel> channels = channels_of(contrasts, settings);
  const Channel& channel = channels.at(band);
  const TabulatedCurve curve = tabulated(settings.curve);
  base::parallel_for(map.pixels.size(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      map.pixels[i] = channel.csf_elevation * mask_elevation(channel, i, like.pixels.data(), curve);
    }
  });
  return map;
}

TargetElevation::TargetElevation(const LocalContrasts& contrasts, const MaskingSettings& settings)
    : contrasts_(contrasts),
      largest_elevation_(settings.largest_elevation),
      csf_elevation_(
          [settings,
           best = csf_peak(find_csf(settings.csf), settings.csf_luminance_cd_m2).sensitivity](
              double f) {
            const double s =
                contrast_sensitivity(find_csf(settings.csf), f, settings.csf_luminance_cd_m2);
            return std::clamp(best / s, 1.0, kLargestCsfElevation);
          }),
      mask_(tabulated(settings.curve)) {
  for (const BandContrast& band : contrasts.bands) {
    sensitivities_.push_back(static_cast<float>(
        mask_sensitivity(settings, band.frequency_cpd, settings.csf_luminance_cd_m2)));
  }
}

/// Also checks that the channels can tell what the target has.
double TargetElevation::csf_elevation_of(const MaskingTarget& target) const {
  if (!(target.frequency_cpd > 0.0)) {
    throw base::InputError(fmt::format("a masking target's frequency is {} cpd; accepted: above 0",
                                       target.frequency_cpd));
  }
  const auto has_no_orientation = [](const BandContrast& band) { return !band.orientation_deg; };
  if (target.orientation_deg && std::ranges::any_of(contrasts_.bands, has_no_orientation)) {
    throw base::InputError(
        "a masking target has an orientation, but the bands have none; accepted: "
        "bands of the kind oriented_octaves, or no orientation");
  }
  return static_cast<double>(csf_elevation_(static_cast<float>(target.frequency_cpd)));
}

/// @param weight_of  how far a channel takes part, by its index
template <typename WeightOf>
double TargetElevation::elevation(std::size_t pixel, double csf_elevation,
                                  const WeightOf& weight_of) const {
  double contrast_sum = 0.0;
  double mask_sum = 0.0;
  for (std::size_t b = 0; b < contrasts_.bands.size(); ++b) {
    const double weight = weight_of(b);
    if (weight == 0.0) continue;
    const float contrast = contrasts_.bands[b].contrast.pixels[pixel];
    contrast_sum += weight * static_cast<double>(contrast);
    mask_sum += weight * static_cast<double>(contrast * mask_(contrast * sensitivities_[b]));
  }
  const double mask = contrast_sum > 0.0 ? mask_sum / contrast_sum : 1.0;
  return std::clamp(csf_elevation * mask, 1.0, largest_elevation_);
}

double TargetElevation::at(std::size_t pixel, const MaskingTarget& target) const {
  return elevation(pixel, csf_elevation_of(target),
                   [&](std::size_t b) { return channel_weight(contrasts_.bands[b], target); });
}

Image TargetElevation::map(const MaskingTarget& target) const {
  const Image& like = contrasts_.adaptation_cd_m2;
  Image result = make_gray_image(like.width_px, like.height_px, "elevation", like.encoding);
  const double csf = csf_elevation_of(target);
  std::vector<double> weights;
  for (const BandContrast& band : contrasts_.bands) weights.push_back(channel_weight(band, target));
  base::parallel_for(result.pixels.size(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      result.pixels[i] =
          static_cast<float>(elevation(i, csf, [&](std::size_t b) { return weights[b]; }));
    }
  });
  return result;
}

double TargetElevation::unmasked(const MaskingTarget& target) const {
  return std::clamp(csf_elevation_of(target), 1.0, largest_elevation_);
}

}  // namespace perception
