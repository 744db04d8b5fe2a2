#include "perception/contrast_sensitivity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "perception/base/names.h"
#include "perception/contrast_sensitivity_models.h"

namespace perception {
namespace {

constexpr CsfTerms kOfLuminance{.luminance = true};
constexpr CsfTerms kOfLuminanceAndArea{.luminance = true, .area = true};
constexpr CsfTerms kOfDaly{.luminance = true,
                           .area = true,
                           .orientation = true,
                           .eccentricity = true,
                           .viewing_distance = true};
constexpr CsfTerms kOfDalyRefitted{
    .luminance = true, .area = true, .eccentricity = true, .viewing_distance = true};
constexpr CsfTerms kOfCastleAchromatic{
    .luminance = true, .area = true, .eccentricity = true, .temporal_frequency = true};

using Normalization = CsfNormalization;

std::array<CsfInfo, 12> all_csfs() {
  namespace m = csf_models;
  return {{
      {"mannos-sakrison",
       "the weight of a picture code; no luminance term",
       "Mannos, Sakrison 1974, doi:10.1109/TIT.1974.1055250",
       Normalization::relative,
       {},
       false,
       m::mannos_sakrison},
      {"daly", "of the Visible Differences Predictor; every term but time",
       "Daly 1993, in Watson (ed.), Digital Images and Human Vision", Normalization::absolute,
       kOfDaly, false, m::daly},
      {"daly-refitted", "Daly's form with constants fitted to the castleCSF data",
       "Ashraf et al. 2024, doi:10.1167/jov.24.4.5, reference code", Normalization::absolute,
       kOfDalyRefitted, false, m::daly_refitted},
      {"barten-1989", "the short form, large fields; in Yee's metric",
       "Barten 1989, doi:10.1117/12.952704", Normalization::absolute, kOfLuminance, false,
       m::barten_1989},
      {"barten-1989-field", "the short form with the size of the field",
       "Barten 1989, doi:10.1117/12.952704", Normalization::absolute, kOfLuminanceAndArea, true,
       m::barten_1989_field},
      {"barten-1999", "from eye optics, photon and neural noise; textbook constants",
       "Barten 1999, Contrast Sensitivity of the Human Eye, doi:10.1117/3.353254",
       Normalization::absolute, kOfLuminanceAndArea, false, m::barten_1999},
      {"barten-2003", "the full form simplified", "Barten 2003, doi:10.1117/12.537476",
       Normalization::absolute, kOfLuminanceAndArea, true, m::barten_2003},
      {"castle-achromatic", "fitted to many data sets; area, eccentricity and time",
       "Ashraf et al. 2024, doi:10.1167/jov.24.4.5, reference code", Normalization::absolute,
       kOfCastleAchromatic, false, m::castle_achromatic},
      {"castle-red-green", "the red-green mechanism, static and foveal",
       "Ashraf et al. 2024, doi:10.1167/jov.24.4.5, reference code", Normalization::cone,
       kOfLuminanceAndArea, false, m::castle_red_green},
      {"castle-violet-yellow", "the violet-yellow mechanism, static and foveal",
       "Ashraf et al. 2024, doi:10.1167/jov.24.4.5, reference code", Normalization::cone,
       kOfLuminanceAndArea, false, m::castle_violet_yellow},
      {"hdr-vdp2", "optics, neural part and luminance sensitivity of HDR-VDP-2.2",
       "Mantiuk et al. 2011, doi:10.1145/1964921.1964935, reference code 2.2.0",
       Normalization::relative, kOfLuminance, false, m::hdr_vdp2},
      {"hdr-vdp3", "the same form with the constants of HDR-VDP-3.0.6",
       "Mantiuk et al. 2023, arXiv:2304.13625, option file 3.0.6", Normalization::absolute,
       kOfLuminance, false, m::hdr_vdp3},
  }};
}

bool are_in_range(const StimulusConditions& c) {
  return c.area_deg2 > 0.0 && std::isfinite(c.orientation_deg) && c.eccentricity_deg >= 0.0 &&
         c.temporal_frequency_hz >= 0.0 && c.viewing_distance_m > 0.0;
}

}  // namespace

std::span<const CsfInfo> csf_list() {
  static const std::array<CsfInfo, 12> kCsfs = all_csfs();
  return kCsfs;
}

const CsfInfo& find_csf(std::string_view name, const base::Place& place) {
  std::vector<std::string> known;
  for (const CsfInfo& info : csf_list()) {
    if (base::is_same_name(info.name, name)) return info;
    known.push_back(info.name);
  }
  throw base::InputError(place, base::unknown_name("contrast sensitivity function", name, known));
}

double contrast_sensitivity(const CsfInfo& csf, double frequency_cpd, double luminance_cd_m2,
                            const StimulusConditions& conditions) {
  const bool is_valid = frequency_cpd >= 0.0 && luminance_cd_m2 >= 0.0 &&
                        std::isfinite(luminance_cd_m2) && are_in_range(conditions);
  if (!is_valid) return std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(frequency_cpd)) return 0.0;
  if (csf.terms.luminance && luminance_cd_m2 == 0.0) return 0.0;
  return csf.formula(frequency_cpd, luminance_cd_m2, conditions);
}

CsfPeak csf_peak(const CsfInfo& csf, double luminance_cd_m2, const StimulusConditions& conditions) {
  const auto at = [&](double octave) {
    return contrast_sensitivity(csf, std::exp2(octave), luminance_cd_m2, conditions);
  };
  // The best of a coarse scan, then golden sections around it.
  constexpr double kStep = 1.0 / 16.0;
  double best = -6.0;
  for (double octave = -6.0; octave <= 6.0; octave += kStep) {
    if (at(octave) > at(best)) best = octave;
  }
  constexpr double kGolden = 0.6180339887498949;
  double low = std::max(best - kStep, -6.0);
  double high = std::min(best + kStep, 6.0);
  while (high - low > 1e-6) {
    const double left = high - kGolden * (high - low);
    const double right = low + kGolden * (high - low);
    (at(left) >= at(right) ? high : low) = at(left) >= at(right) ? right : left;
  }
  const double octave = 0.5 * (low + high);
  return {std::exp2(octave), at(octave)};
}

}  // namespace perception
