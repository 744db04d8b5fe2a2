// Ramasubramanian, Pattanaik, Greenberg 1999, "A Perceptually Based Physical Error Metric for
//   Realistic Image Synthesis", doi:10.1145/311535.311543. Of the paper only the abstract was at
//   hand: luminance-dependent and spatial parts are independent factors, the spatial one is
//   computed once. Bands, contrast and the weighted mean are those of its descendant,
// Yee 2004, "A Perceptual Metric for Production Testing", doi:10.1080/10867651.2004.10504901, as
//   its public code has them.
// Daly 1993, "The Visible Differences Predictor", in Watson (ed.), Digital Images and Human
//   Vision, MIT Press: the elevation curve, mutual masking.

#include "perception/visual_masking.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/names.h"

namespace perception {
namespace {

/// A profile by name.
struct Profile {
  const char* name;
  MaskingSettings settings;
};

/// Chosen by suites/catalog/psychophysics/calibration.yaml: 5.2 dB rms from people on the half of
/// the data that chose, 5.5 dB on the other, with thresholds of a fifth (threshold_profile); rama99
/// itself 15.0 and 19.0 dB. Without neutral contrast a gain of 0.5 and a clamp of 2 come to 4.9
/// and 5.1 dB, and the least noise elevates to that clamp.
MaskingSettings calibrated() {
  MaskingSettings settings;
  settings.csf_gain = 1.0;
  settings.largest_elevation = 3.0;
  settings.neutral_contrast = 0.05;
  return settings;
}

std::array<Profile, 3> all_profiles() {
  MaskingSettings yee;
  yee.curve = yee_masking_curve();
  yee.bands = MaskingBands::repeated_kernel;
  yee.lowest_frequency_cpd = 0.0;
  yee.pair = PairContrast::maximum;
  yee.is_yee_adaptation = true;
  return {
      {{"rama99", MaskingSettings{}}, {"rama99_calibrated", calibrated()}, {"yee_compat", yee}}};
}

void require(bool is_fine, const char* what, double value, const char* accepted) {
  if (is_fine) return;
  throw base::InputError(
      fmt::format("masking setting {} is {}; accepted: {}", what, value, accepted));
}

}  // namespace

MaskingCurve daly_masking_curve(double slope, double knee) {
  constexpr double kW = 6.0;
  constexpr double kQ = 0.7;
  return {std::pow(kW, 1.0 - 1.0 / (1.0 - kQ)), std::pow(kW, 1.0 / (1.0 - kQ)), slope, knee};
}

MaskingCurve yee_masking_curve() { return {0.0153, 392.498, 0.7, 4.0}; }

double threshold_elevation(double normalized_contrast, const MaskingCurve& curve) {
  if (std::isnan(normalized_contrast)) return normalized_contrast;
  const double masked =
      curve.k1 * std::pow(curve.k2 * std::max(normalized_contrast, 0.0), curve.slope);
  // (1 + x^b)^(1/b) is x beyond where the sum would overflow.
  if (masked > 1e30) return masked;
  return std::pow(1.0 + std::pow(masked, curve.knee), 1.0 / curve.knee);
}

std::vector<std::string> masking_profile_names() {
  std::vector<std::string> names;
  for (const Profile& profile : all_profiles()) names.emplace_back(profile.name);
  return names;
}

MaskingSettings masking_profile(std::string_view name, const base::Place& place) {
  for (const Profile& profile : all_profiles()) {
    if (base::is_same_name(profile.name, name)) return profile.settings;
  }
  throw base::InputError(place,
                         base::unknown_name("masking profile", name, masking_profile_names()));
}

void check(const MaskingSettings& settings) {
  const CsfInfo& csf = find_csf(settings.csf);
  if (csf.normalization == CsfNormalization::cone) {
    throw base::InputError(fmt::format(
        "masking setting csf is \"{}\", of colour; accepted: achromatic functions", csf.name));
  }
  const double bands = settings.band_count;
  require(settings.csf_gain > 0.0, "csf_gain", settings.csf_gain, "above 0");
  require(settings.csf_luminance_cd_m2 > 0.0, "csf_luminance_cd_m2", settings.csf_luminance_cd_m2,
          "above 0");
  require(bands >= 1 && bands <= 12, "band_count", bands, "1 to 12");
  require(settings.lowest_frequency_cpd >= 0.0, "lowest_frequency_cpd",
          settings.lowest_frequency_cpd, "0 and above");
  require(settings.largest_elevation >= 1.0, "largest_elevation", settings.largest_elevation,
          "1 and above");
  require(settings.neutral_contrast >= 0.0, "neutral_contrast", settings.neutral_contrast,
          "0 and above");
  require(settings.adaptation_sigma_deg >= 0.0, "adaptation_sigma_deg",
          settings.adaptation_sigma_deg, "0 and above");
  require(settings.curve.k1 >= 0.0, "k1", settings.curve.k1, "0 and above");
  require(settings.curve.k2 >= 0.0, "k2", settings.curve.k2, "0 and above");
  require(settings.curve.slope > 0.0, "slope", settings.curve.slope, "above 0");
  require(settings.curve.knee > 0.0, "knee", settings.curve.knee, "above 0");
}

}  // namespace perception
