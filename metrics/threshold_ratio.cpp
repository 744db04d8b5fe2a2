#include "metrics/threshold_ratio.h"

#include <cmath>
#include <memory>
#include <utility>

#include "metrics/image_region.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "perception/threshold_map.h"

namespace metrics {
namespace {

constexpr const char* kName = "threshold-ratio";

struct RatioSettings {
  perception::ThresholdSettings thresholds;
  ImageRegion region;
};

Image thresholds_of(const Image& image, const ViewingConditions& viewing,
                    const perception::ThresholdSettings& settings) {
  return perception::threshold_map(light_input(image, viewing).image(), viewing, settings)
      .threshold_cd_m2;
}

/// value(pixel) in a map of the size of another.
template <typename Value>
Image map_like(const Image& like, const char* channel, const Value& value) {
  Image map = perception::make_gray_image(like.width_px, like.height_px, channel,
                                          perception::Encoding::scene_linear);
  for_each_pixel(map, [&](std::size_t i) { map.pixels[i] = value(i); });
  return map;
}

class ThresholdRatio : public Metric {
 public:
  explicit ThresholdRatio(RatioSettings settings) : settings_(std::move(settings)) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const Image expected = thresholds_of(pair.reference, viewing, settings_.thresholds);
    const Image found = thresholds_of(pair.test, viewing, settings_.thresholds);
    const Image mask = region_mask(settings_.region, expected, pair.mask, kName);

    // A difference of logarithms keeps its size exactly when the images change places.
    Image octaves = map_like(expected, "octaves", [&](std::size_t i) {
      return std::log2(found.pixels[i]) - std::log2(expected.pixels[i]);
    });
    const Image distance =
        map_like(octaves, "distance", [&](std::size_t i) { return std::abs(octaves.pixels[i]); });
    const Image lowered =
        map_like(octaves, "lowered", [&](std::size_t i) { return -octaves.pixels[i]; });
    const auto ratio_at = [&](double share) {
      return std::exp2(masked_quantile(octaves, &mask, share));
    };

    Score score;
    score.value = masked_quantile(distance, &mask, 0.5);
    score.details = {{"ratio", ratio_at(0.5)},
                     {"ratio_p05", ratio_at(0.05)},
                     {"ratio_p95", ratio_at(0.95)},
                     {"above_double", masked_share_above(octaves, &mask, 1.0F)},
                     {"below_half", masked_share_above(lowered, &mask, 1.0F)},
                     {"threshold_median_cd_m2", masked_quantile(found, &mask, 0.5)},
                     {"reference_threshold_median_cd_m2", masked_quantile(expected, &mask, 0.5)}};
    score.map = std::move(octaves);
    return score;
  }

 private:
  RatioSettings settings_;
};

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = {
      base::choice_parameter("profile", perception::masking_profile_names(), "rama99_calibrated",
                             "Model of both images' thresholds, as of `discern thresholds`.")};
  for (base::ParameterSpec& one : region_parameters()) specs.push_back(std::move(one));
  return specs;
}

}  // namespace

MetricInfo threshold_ratio_info() {
  MetricInfo info;
  info.name = kName;
  info.summary =
      "Median of |log2 r| over the pixels, r being the threshold that the image's own light and "
      "contrasts give a pixel over the one that the reference's do, TVI x CSF x masking each.";
  info.unit = "octaves";
  info.source = "ours";
  info.better = Better::lower;
  info.input = "absolute light";
  info.identical_value = 0.0;
  info.parameters = parameter_specs();
  info.shares_model_with = {"grid-final-gather"};
  info.map_unit = "octaves";
  info.map_scale = {-2.0, 2.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    RatioSettings settings;
    settings.thresholds = perception::threshold_profile(parameters.text("profile"));
    settings.region = read_region(parameters, kName);
    return std::make_unique<ThresholdRatio>(std::move(settings));
  };
  return info;
}

}  // namespace metrics
