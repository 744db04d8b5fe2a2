// Yee 2004, as in yee.h. Two tests per pixel: |difference of luminance| > F TVI(L_a), and
// (da^2 + db^2) > F in CIELAB, F the elevation of the profile yee_compat; in dim places the second
// counts a hundredth (the public codes differ there; this is OpenImageIO's).
//
// Differs from the code: luminance and CIELAB are those of linear Rec.709 light, where the code
// takes Adobe RGB; size and light of a pixel come from the viewing conditions; contrast is the
// larger of the two images' contrasts, where the code divides the larger band by the larger
// surround.

#include "metrics/yee.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "metrics/visible_bands.h"
#include "perception/color_conversion.h"
#include "perception/tabulated_curve.h"
#include "perception/threshold_map.h"

namespace metrics {
namespace {

constexpr float kDarkest_cd_m2 = 1e-5F;
constexpr double kFewFailures = 100.0;  ///< fewer failing pixels are a pass (the code's default)

/// Weight of the colour test by adapting luminance: (1 - (10 - 1) / 10)^2 below 10 cd/m2.
float color_weight(float adaptation_cd_m2) { return adaptation_cd_m2 < 10.0F ? 0.01F : 1.0F; }

/// CIELAB's cube root with its straight toe.
const perception::TabulatedCurve& lab_root() {
  static const perception::TabulatedCurve kRoot([](double t) {
    constexpr double kToe = 216.0 / 24389.0;
    return t > kToe ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  });
  return kRoot;
}

/// The columns of a*, b*: chromaticness of light relative to a white.
class Chromaticness {
 public:
  explicit Chromaticness(float white_cd_m2) {
    const auto white = perception::xyz_from_linear_rgb({1.0F, 1.0F, 1.0F});
    for (std::size_t c = 0; c < 3; ++c) scale_[c] = 1.0F / (white[c] * white_cd_m2);
  }

  /// {a*, b*}
  std::array<float, 2> of(const float* rgb) const {
    const auto xyz = perception::xyz_from_linear_rgb({rgb[0], rgb[1], rgb[2]});
    const auto& root = lab_root();
    const float x = root(std::max(scale_[0] * xyz[0], 0.0F));
    const float y = root(std::max(scale_[1] * xyz[1], 0.0F));
    const float z = root(std::max(scale_[2] * xyz[2], 0.0F));
    return {500.0F * (x - y), 200.0F * (y - z)};
  }

 private:
  std::array<float, 3> scale_{};
};

/// Luminance of the display's white: its peak and what the screen reflects.
float white_cd_m2(const ViewingConditions& viewing) {
  return static_cast<float>(viewing.peak_cd_m2 +
                            viewing.ambient_lux * viewing.screen_reflectance / std::numbers::pi);
}

/// Thresholds of both tests.
perception::ThresholdMap yee_thresholds(const Image& reference, const Image& test,
                                        const ViewingConditions& viewing) {
  perception::ThresholdSettings settings;
  settings.masking = perception::masking_profile("yee_compat");
  return perception::threshold_map(reference, test, viewing, settings);
}

/// How often the larger of the two tests' differences exceeds its threshold.
Image ratio_map(const Image& reference, const Image& test, const ViewingConditions& viewing) {
  const Image reference_y = luminance_of(reference);
  const Image test_y = luminance_of(test);
  const perception::ThresholdMap thresholds = yee_thresholds(reference_y, test_y, viewing);
  const Chromaticness chromaticness(white_cd_m2(viewing));
  Image map = perception::make_gray_image(reference.width_px, reference.height_px, "ratio",
                                          perception::Encoding::scene_linear);
  for_each_row(map.height_px, [&](int y) {
    const std::size_t begin = map.offset(0, y);
    const std::size_t end = begin + static_cast<std::size_t>(map.width_px);
    for (std::size_t i = begin; i < end; ++i) {
      const float* r = &reference.pixels[3 * i];
      const float* t = &test.pixels[3 * i];
      if (std::equal(r, r + 3, t)) continue;
      const float luminance_ratio =
          std::abs(test_y.pixels[i] - reference_y.pixels[i]) / thresholds.threshold_cd_m2.pixels[i];
      const auto [ra, rb] = chromaticness.of(r);
      const auto [ta, tb] = chromaticness.of(t);
      const float square = (ta - ra) * (ta - ra) + (tb - rb) * (tb - rb);
      const float adaptation = std::max(thresholds.adaptation_cd_m2.pixels[i], kDarkest_cd_m2);
      const float color_ratio = square * color_weight(adaptation) / thresholds.elevation.pixels[i];
      map.pixels[i] = std::max(luminance_ratio, color_ratio);
    }
  });
  return map;
}

class Yee : public Metric {
 public:
  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const InputImage reference = light_input(pair.reference, viewing);
    const InputImage test = light_input(pair.test, viewing);
    Score score;
    score.map = ratio_map(reference.image(), test.image(), viewing);
    const double failing = sum_over_rows(score.map->height_px, [&](int y) {
      double row = 0.0;
      for (int x = 0; x < score.map->width_px; ++x) {
        const std::size_t i = score.map->offset(x, y);
        if (score.map->pixels[i] > 1.0F && takes_part(pair.mask, i)) row += 1.0;
      }
      return row;
    });
    score.value = failing / static_cast<double>(pooled_pixel_count(*score.map, pair.mask));
    const MapExtremes extremes = map_extremes(*score.map, pair.mask);
    score.details = {{"failing_pixels", failing},
                     {"is_pass", failing < kFewFailures ? 1.0 : 0.0},
                     {"maximum", extremes.maximum},
                     {"maximum_x_px", static_cast<double>(extremes.max_x_px)},
                     {"maximum_y_px", static_cast<double>(extremes.max_y_px)}};
    return score;
  }
};

}  // namespace

MetricInfo yee_info() {
  MetricInfo info;
  info.name = "yee";
  info.summary =
      "Fraction of the pixels that fail the luminance or the colour test of perceptualdiff; fewer "
      "than 100 of them are a pass.";
  info.unit = "";
  info.source = "Yee 2004, doi:10.1080/10867651.2004.10504901";
  info.better = Better::lower;
  info.input = "absolute light";
  info.identical_value = 0.0;
  info.shares_model_with = {"grid-final-gather"};
  info.map_unit = "thresholds";
  info.map_scale = {0.0, 5.0, false, info.map_unit};
  info.create = [](const base::Parameters&) -> std::unique_ptr<Metric> {
    return std::make_unique<Yee>();
  };
  return info;
}

}  // namespace metrics
