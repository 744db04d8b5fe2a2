#include "perception/perceptual_encoding.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace perception {
namespace {

/// p1 to p7 of the fit.
using Constants = std::array<double, 7>;

struct NamedCurve {
  PerceptualCurve curve;
  const char* name;
  Constants p;
};

// The authors' program, pu21_encoder.
constexpr std::array<NamedCurve, 4> kCurves{{
    {PerceptualCurve::banding,
     "banding",
     {1.070275272, 0.4088273932, 0.153224308, 0.2520326168, 1.063512885, 1.14115047, 521.4527484}},
    {PerceptualCurve::banding_glare,
     "banding_glare",
     {0.353487901, 0.3734658629, 8.277049286e-05, 0.9062562627, 0.09150303166, 0.9099517204,
      596.3148142}},
    {PerceptualCurve::peaks,
     "peaks",
     {1.043882782, 0.6459495343, 0.3194584211, 0.374025247, 1.114783422, 1.095360363, 384.9217577}},
    {PerceptualCurve::peaks_glare,
     "peaks_glare",
     {816.885024, 1479.463946, 0.001253215609, 0.9329636822, 0.06746643971, 1.573435413,
      419.6006374}},
}};

const Constants& constants_of(PerceptualCurve curve) {
  return kCurves[static_cast<std::size_t>(curve)].p;
}

}  // namespace

std::string to_string(PerceptualCurve curve) {
  return kCurves[static_cast<std::size_t>(curve)].name;
}

PerceptualCurve perceptual_curve_from_text(std::string_view text) {
  for (const NamedCurve& known : kCurves) {
    if (base::is_same_name(known.name, text)) return known.curve;
  }
  throw base::InputError(base::unknown_name("perceptual encoding", text, perceptual_curve_names()));
}

std::vector<std::string> perceptual_curve_names() {
  std::vector<std::string> names;
  for (const NamedCurve& known : kCurves) names.emplace_back(known.name);
  return names;
}

bool is_in_pu_range(double luminance_cd_m2) {
  return luminance_cd_m2 >= kPuLowest_cd_m2 && luminance_cd_m2 <= kPuHighest_cd_m2;
}

double pu_encode(double luminance_cd_m2, PerceptualCurve curve) {
  if (std::isnan(luminance_cd_m2)) return luminance_cd_m2;
  const Constants& p = constants_of(curve);
  const double bounded = std::clamp(luminance_cd_m2, kPuLowest_cd_m2, kPuHighest_cd_m2);
  const double power = std::pow(bounded, p[3]);
  const double ratio = (p[0] + p[1] * power) / (1.0 + p[2] * power);
  return std::max(p[6] * (std::pow(ratio, p[4]) - p[5]), 0.0);
}

double pu_decode(double value, PerceptualCurve curve) {
  const double lowest = pu_encode(kPuLowest_cd_m2, curve);
  const double highest = pu_encode(kPuHighest_cd_m2, curve);
  if (!(value >= lowest && value <= highest)) {
    throw base::InputError(
        fmt::format("{} is not a PU value of the encoding \"{}\"; accepted: {:.4f} to {:.4f}",
                    value, to_string(curve), lowest, highest));
  }
  const Constants& p = constants_of(curve);
  const double ratio = std::pow(value / p[6] + p[5], 1.0 / p[4]);
  const double power = std::max(ratio - p[0], 0.0) / (p[1] - p[2] * ratio);
  return std::clamp(std::pow(power, 1.0 / p[3]), kPuLowest_cd_m2, kPuHighest_cd_m2);
}

}  // namespace perception
