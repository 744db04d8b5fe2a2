#include "metrics/edge_excess.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "metrics/image_region.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "metrics/visible_bands.h"
#include "perception/base/names.h"
#include "perception/threshold_map.h"

namespace metrics {
namespace {

constexpr const char* kName = "edge-excess";

struct EdgeSettings {
  perception::ThresholdSettings thresholds;
  bool has_elevation = false;  ///< thresholds are raised by the reference's content
  ImageRegion region;
};

EdgeSettings read_settings(const base::Parameters& parameters) {
  const std::string& masking = parameters.text("masking");
  const VisibilitySettings shared = visibility_settings(
      masking == "separate" ? VisibilityModel::separate : VisibilityModel::joint,
      base::kebab_case(parameters.text("csf")), parameters.text("tvi"),
      parameters.real("tvi_scale"));
  EdgeSettings settings;
  settings.thresholds.curve = shared.curve;
  settings.thresholds.threshold_scale = shared.tvi_scale;
  settings.thresholds.masking = shared.masking;
  settings.has_elevation = masking != "off";
  settings.region = read_region(parameters, kName);
  return settings;
}

/// Share of the pixels with a step above their threshold.
double share_of_steps(const Image& luminance, const Image& threshold_cd_m2, const Image& mask) {
  const Image flat =
      perception::make_gray_image(luminance.width_px, luminance.height_px, "Y", luminance.encoding);
  const double steps = sum_over_rows(luminance.height_px, [&](int y) {
    double row = 0.0;
    for (int x = 0; x < luminance.width_px; ++x) {
      if (!takes_part(&mask, mask.offset(x, y))) continue;
      row += excess_step(flat, luminance, threshold_cd_m2, x, y) > 0.0F ? 1.0 : 0.0;
    }
    return row;
  });
  return steps / static_cast<double>(pooled_pixel_count(luminance, &mask));
}

class EdgeExcess : public Metric {
 public:
  explicit EdgeExcess(EdgeSettings settings) : settings_(std::move(settings)) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const Image reference = luminance_of(light_input(pair.reference, viewing).image());
    const Image test = luminance_of(light_input(pair.test, viewing).image());
    const Image mask = region_mask(settings_.region, reference, pair.mask, kName);
    const perception::ThresholdMap thresholds =
        perception::threshold_map(reference, viewing, settings_.thresholds);
    const Image& threshold =
        settings_.has_elevation ? thresholds.threshold_cd_m2 : thresholds.tvi_cd_m2;
    Score score;
    score.map = perception::make_gray_image(reference.width_px, reference.height_px, "steps",
                                            perception::Encoding::scene_linear);
    for_each_row(reference.height_px, [&](int y) {
      for (int x = 0; x < reference.width_px; ++x) {
        score.map->at(x, y) = excess_step(reference, test, threshold, x, y);
      }
    });
    score.value = masked_share_above(*score.map, &mask, 0.0F);
    const MapExtremes extremes = map_extremes(*score.map, &mask);
    score.details = {{"steps", share_of_steps(test, threshold, mask)},
                     {"reference_steps", share_of_steps(reference, threshold, mask)},
                     {"largest_step", extremes.maximum},
                     {"largest_step_x_px", static_cast<double>(extremes.max_x_px)},
                     {"largest_step_y_px", static_cast<double>(extremes.max_y_px)},
                     {"threshold_mean_cd_m2", masked_mean(threshold, &mask)}};
    return score;
  }

 private:
  EdgeSettings settings_;
};

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = visibility_parameters();
  specs.push_back(base::choice_parameter(
      "masking", {"off", "joint", "separate"}, "off",
      "What raises the threshold of a step: nothing, or CSF and the reference's content by one "
      "threshold per pixel, as a weighted mean or in two factors; ours."));
  for (base::ParameterSpec& one : region_parameters()) specs.push_back(std::move(one));
  return specs;
}

}  // namespace

float excess_step(const Image& reference, const Image& test, const Image& threshold_cd_m2, int x,
                  int y) {
  const float threshold = threshold_cd_m2.at(x, y);
  const auto excess_to = [&](int next_x, int next_y) {
    if (next_x == reference.width_px || next_y == reference.height_px) return 0.0F;
    const float step = std::abs(test.at(next_x, next_y) - test.at(x, y));
    const bool is_excess = step > threshold &&
                           std::abs(reference.at(next_x, next_y) - reference.at(x, y)) <= threshold;
    return is_excess ? step / threshold : 0.0F;
  };
  return std::max(excess_to(x + 1, y), excess_to(x, y + 1));
}

MetricInfo edge_excess_info() {
  MetricInfo info;
  info.name = kName;
  info.summary =
      "Share of the pixels whose step in display luminance to the right or lower neighbour is "
      "above the reference's threshold while the reference's own step is not: bands, seams, "
      "stairs.";
  info.source = "ours";
  info.better = Better::lower;
  info.input = "absolute light";
  info.identical_value = 0.0;
  info.parameters = parameter_specs();
  info.shares_model_with = {"grid-final-gather"};
  info.map_unit = "thresholds";
  info.map_scale = {0.0, 5.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<EdgeExcess>(read_settings(parameters));
  };
  return info;
}

}  // namespace metrics
