// Ferwerda, Pattanaik, Shirley, Greenberg 1996, "A Model of Visual Adaptation for Realistic Image
//   Synthesis", doi:10.1145/237170.237262: the piecewise fits of rods and cones.
// Ward Larson, Rushmeier, Piatko 1997, "A Visibility Matching Tone Reproduction Operator for High
//   Dynamic Range Scenes", doi:10.1109/2945.646233: the table that joins the two.
// Mantiuk, Kim, Rempel, Heidrich 2011, "HDR-VDP-2", doi:10.1145/1964921.1964935: the luminance
//   sensitivity S_A, with the constants of the reference code 2.2.0 and of 3.0.6.
// The pieces were checked against public implementations of the first two (Radiance's pcond3.c,
// tone mappers); the numbers of their equations and tables in the papers are not at hand.

#include "perception/threshold_vs_intensity.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace perception {
namespace {

constexpr std::array<ThresholdCurve, 6> kCurves{
    ThresholdCurve::ferwerda_cones, ThresholdCurve::ferwerda_rods, ThresholdCurve::ward,
    ThresholdCurve::ward_smooth,    ThresholdCurve::hdr_vdp2,      ThresholdCurve::weber};

/// Breaks of the pieces, log10 of cd/m2.
constexpr double kConesDark = -2.6;
constexpr double kConesBright = 1.9;
constexpr double kRodsDark = -3.94;
constexpr double kRodsBright = -1.44;
constexpr double kWardCrossing = -0.0184;  ///< where the cones take over

/// Ours: half the width over which `ward_smooth` passes from piece to piece, log10 units.
constexpr double kBlendHalfWidth = 0.1;

constexpr double kWeberFraction = 0.02;

// In all pieces: l = log10 of the adapting luminance in cd/m2; the result is log10 of cd/m2.

double cones_power(double l) { return std::pow(std::max(0.249 * l + 0.65, 0.0), 2.7) - 0.72; }
double cones_line(double l) { return l - 1.255; }
double rods_power(double l) { return std::pow(std::max(0.405 * l + 1.6, 0.0), 2.18) - 2.86; }
double rods_line(double l) { return l - 0.395; }

double cones(double l) {
  if (l <= kConesDark) return -0.72;
  return l < kConesBright ? cones_power(l) : cones_line(l);
}

double rods(double l) {
  if (l <= kRodsDark) return -2.86;
  return l < kRodsBright ? rods_power(l) : rods_line(l);
}

double ward(double l) {
  if (l < kRodsDark) return -2.86;
  if (l < kRodsBright) return rods_power(l);
  if (l < kWardCrossing) return rods_line(l);
  return l < kConesBright ? cones_power(l) : cones_line(l);
}

/// From `low` to `high` around a break with a cubic of zero slope at both ends.
double blended(double l, double at, double low, double high) {
  const double t = std::clamp((l - at) / (2.0 * kBlendHalfWidth) + 0.5, 0.0, 1.0);
  const double weight = t * t * (3.0 - 2.0 * t);
  return low + weight * (high - low);
}

/// The power pieces, floored at their own zero, meet the dark plateaus; only the bright breaks and
/// the crossing of rods and cones need care.
double ward_smooth(double l) {
  return std::min(blended(l, kRodsBright, rods_power(l), rods_line(l)),
                  blended(l, kConesBright, cones_power(l), cones_line(l)));
}

/// A sensitivity law of HDR-VDP: s1 ((s2 / L)^s3 + 1)^-s4.
double luminance_sensitivity(const std::array<double, 4>& s, double luminance) {
  if (std::isnan(luminance)) return luminance;
  if (luminance <= 0.0) return 0.0;
  return s[0] * std::pow(std::pow(s[1] / luminance, s[2]) + 1.0, -s[3]);
}

}  // namespace

std::string to_string(ThresholdCurve curve) {
  switch (curve) {
    case ThresholdCurve::ferwerda_cones:
      return "ferwerda_cones";
    case ThresholdCurve::ferwerda_rods:
      return "ferwerda_rods";
    case ThresholdCurve::ward:
      return "ward";
    case ThresholdCurve::ward_smooth:
      return "ward_smooth";
    case ThresholdCurve::hdr_vdp2:
      return "hdr_vdp2";
    case ThresholdCurve::weber:
      return "weber";
  }
  assert(false);
  return "";
}

std::vector<std::string> threshold_curve_names() {
  std::vector<std::string> names;
  for (const ThresholdCurve curve : kCurves) names.push_back(to_string(curve));
  return names;
}

ThresholdCurve threshold_curve_from_text(std::string_view text) {
  for (const ThresholdCurve curve : kCurves) {
    if (base::is_same_name(to_string(curve), text)) return curve;
  }
  throw base::InputError(base::unknown_name("threshold curve", text, threshold_curve_names()));
}

double hdr_vdp2_luminance_sensitivity(double luminance_cd_m2) {
  return luminance_sensitivity({30.162, 4.0627, 1.6596, 0.2712}, luminance_cd_m2);
}

double hdr_vdp3_luminance_sensitivity(double luminance_cd_m2) {
  return luminance_sensitivity({315.98, 6.7977, 1.6008, 0.25534}, luminance_cd_m2);
}

double threshold_cd_m2(ThresholdCurve curve, double luminance_cd_m2) {
  if (!std::isfinite(luminance_cd_m2) && !(luminance_cd_m2 < 0.0)) return luminance_cd_m2;
  const double luminance = std::max(luminance_cd_m2, 0.0);
  const double l = std::log10(luminance);  // minus infinity in darkness: the dark plateaus
  switch (curve) {
    case ThresholdCurve::ferwerda_cones:
      return std::pow(10.0, cones(l));
    case ThresholdCurve::ferwerda_rods:
      return std::pow(10.0, rods(l));
    case ThresholdCurve::ward:
      return std::pow(10.0, ward(l));
    case ThresholdCurve::ward_smooth:
      return std::pow(10.0, luminance > 0.0 ? ward_smooth(l) : -2.86);
    case ThresholdCurve::hdr_vdp2:
      return luminance > 0.0 ? luminance / hdr_vdp2_luminance_sensitivity(luminance) : 0.0;
    case ThresholdCurve::weber:
      return kWeberFraction * luminance;
  }
  assert(false);
  return 0.0;
}

}  // namespace perception
