#include "metrics/color_difference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "perception/color_conversion.h"

namespace metrics {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

double power_7(double x) {
  const double cube = x * x * x;
  return cube * cube * x;
}

/// sqrt(C^7 / (C^7 + 25^7)): 0 for greys, 1 for saturated colours.
double saturation_term(double chroma) {
  constexpr double k25To7 = 6103515625.0;
  const double power = power_7(chroma);
  return std::sqrt(power / (power + k25To7));
}

/// Hue of (a', b') in [0, 360) degrees, 0 for grey (Eq. 7).
double hue_deg(double a, double b) {
  if (a == 0.0 && b == 0.0) return 0.0;
  const double angle = std::atan2(b, a) / kDegree_rad;
  return angle < 0.0 ? angle + 360.0 : angle;
}

/// L', C', h' of the adjusted colour (Eq. 2 to 7).
struct AdjustedColor {
  double lightness, chroma, hue_deg;
};

AdjustedColor adjusted(const Lab& color, double mean_chroma) {
  const double gain = 1.0 + 0.5 * (1.0 - saturation_term(mean_chroma));  // 1 + G, Eq. 4 and 5
  const double a = gain * color[1];
  return {color[0], std::hypot(a, color[2]), hue_deg(a, color[2])};
}

/// Difference of hues in [-180, 180] degrees, 0 if one colour is grey (Eq. 10).
double hue_difference_deg(const AdjustedColor& p, const AdjustedColor& q) {
  if (p.chroma * q.chroma == 0.0) return 0.0;
  const double difference = q.hue_deg - p.hue_deg;
  if (difference > 180.0) return difference - 360.0;
  if (difference < -180.0) return difference + 360.0;
  return difference;
}

/// Mean hue on the shorter arc, the sum if one colour is grey (Eq. 14).
double mean_hue_deg(const AdjustedColor& p, const AdjustedColor& q) {
  const double sum = p.hue_deg + q.hue_deg;
  if (p.chroma * q.chroma == 0.0) return sum;
  if (std::abs(p.hue_deg - q.hue_deg) <= 180.0) return 0.5 * sum;
  return sum < 360.0 ? 0.5 * (sum + 360.0) : 0.5 * (sum - 360.0);
}

double cosine_deg(double angle_deg) { return std::cos(angle_deg * kDegree_rad); }

/// Weight of hue differences around a mean hue (Eq. 15).
double hue_weight(double hue) {
  return 1.0 - 0.17 * cosine_deg(hue - 30.0) + 0.24 * cosine_deg(2.0 * hue) +
         0.32 * cosine_deg(3.0 * hue + 6.0) - 0.20 * cosine_deg(4.0 * hue - 63.0);
}

/// Rotation term between chroma and hue, for blues (Eq. 16, 17 and 21).
double rotation_term(double mean_chroma, double mean_hue) {
  const double distance = (mean_hue - 275.0) / 25.0;
  const double angle_deg = 30.0 * std::exp(-distance * distance);
  return -std::sin(2.0 * angle_deg * kDegree_rad) * 2.0 * saturation_term(mean_chroma);
}

/// Luminance of the display's white: its peak and what the screen reflects.
double white_cd_m2(const ViewingConditions& viewing) {
  return viewing.peak_cd_m2 + viewing.ambient_lux * viewing.screen_reflectance / std::numbers::pi;
}

Lab lab_of(const float* light, float inverse_white) {
  const auto xyz = perception::xyz_from_linear_rgb(
      {light[0] * inverse_white, light[1] * inverse_white, light[2] * inverse_white});
  const auto lab = perception::lab_from_xyz(xyz);
  return {double{lab[0]}, double{lab[1]}, double{lab[2]}};
}

class ColorDifference : public Metric {
 public:
  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const InputImage reference = light_input(pair.reference, viewing);
    const InputImage test = light_input(pair.test, viewing);
    Score score;
    score.map = difference_map(reference.image(), test.image(), white_cd_m2(viewing));
    score.value = masked_mean(*score.map, pair.mask);
    const MapExtremes extremes = map_extremes(*score.map, pair.mask);
    score.details = {{"p95", masked_quantile(*score.map, pair.mask, 0.95)},
                     {"maximum", extremes.maximum},
                     {"maximum_x_px", static_cast<double>(extremes.max_x_px)},
                     {"maximum_y_px", static_cast<double>(extremes.max_y_px)},
                     {"white_cd_m2", white_cd_m2(viewing)}};
    return score;
  }

 private:
  static Image difference_map(const Image& reference, const Image& test, double white) {
    Image map = perception::make_gray_image(reference.width_px, reference.height_px, "error",
                                            perception::Encoding::scene_linear);
    const auto inverse_white = static_cast<float>(1.0 / white);
    for_each_row(map.height_px, [&](int y) {
      const float* r = &reference.pixels[reference.offset(0, y)];
      const float* t = &test.pixels[test.offset(0, y)];
      float* out = &map.pixels[map.offset(0, y)];
      for (int x = 0; x < map.width_px; ++x, r += 3, t += 3) {
        const bool is_equal = std::equal(r, r + 3, t);
        if (!is_equal) {
          out[x] =
              static_cast<float>(ciede2000(lab_of(r, inverse_white), lab_of(t, inverse_white)));
        }
      }
    });
    return map;
  }
};

}  // namespace

double ciede2000(const Lab& first, const Lab& second) {
  const double mean_plain_chroma =
      0.5 * (std::hypot(first[1], first[2]) + std::hypot(second[1], second[2]));
  const AdjustedColor p = adjusted(first, mean_plain_chroma);
  const AdjustedColor q = adjusted(second, mean_plain_chroma);

  // Differences (Eq. 8 to 11).
  const double lightness = q.lightness - p.lightness;
  const double chroma = q.chroma - p.chroma;
  const double hue =
      2.0 * std::sqrt(p.chroma * q.chroma) * std::sin(0.5 * hue_difference_deg(p, q) * kDegree_rad);

  // Weights around the mean colour (Eq. 12 to 20).
  const double mean_chroma = 0.5 * (p.chroma + q.chroma);
  const double mean_hue = mean_hue_deg(p, q);
  const double from_grey = 0.5 * (p.lightness + q.lightness) - 50.0;
  const double square = from_grey * from_grey;
  const double lightness_part = lightness / (1.0 + 0.015 * square / std::sqrt(20.0 + square));
  const double chroma_part = chroma / (1.0 + 0.045 * mean_chroma);
  const double hue_part = hue / (1.0 + 0.015 * mean_chroma * hue_weight(mean_hue));

  // Eq. 22; rounding may take the sum a little below 0.
  const double sum = lightness_part * lightness_part + chroma_part * chroma_part +
                     hue_part * hue_part +
                     rotation_term(mean_chroma, mean_hue) * chroma_part * hue_part;
  return std::sqrt(std::max(sum, 0.0));
}

MetricInfo delta_e_2000_info() {
  MetricInfo info;
  info.name = "delta-e-2000";
  info.summary =
      "Mean colour difference CIEDE2000 of the light the display emits, in CIELAB relative to the "
      "display's white (peak and reflection). It knows nothing of detail: every pixel is a patch.";
  info.unit = "Delta E00";
  info.source = "Sharma, Wu, Dalal 2005, doi:10.1002/col.20070";
  info.better = Better::lower;
  info.input = "absolute light";
  info.identical_value = 0.0;
  info.map_unit = info.unit;
  info.map_scale = {0.0, 10.0, false, info.map_unit};
  info.create = [](const base::Parameters&) -> std::unique_ptr<Metric> {
    return std::make_unique<ColorDifference>();
  };
  return info;
}

}  // namespace metrics
