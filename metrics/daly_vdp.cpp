#include "metrics/daly_vdp.h"

#include <utility>

#include "metrics/daly_channels.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/visible_bands.h"
#include "metrics/visible_regions.h"

namespace metrics {
namespace {

constexpr std::size_t kMostRegions = 20;

/// Share of the pixels that are seen with at least a probability.
double share_seen(const Image& probability, const Image* mask, double at_least) {
  const double sum = sum_over_rows(probability.height_px, [&](int y) {
    double row = 0.0;
    for (int x = 0; x < probability.width_px; ++x) {
      if (takes_part(mask, probability.offset(x, y)) && double{probability.at(x, y)} >= at_least) {
        row += 1.0;
      }
    }
    return row;
  });
  return sum / static_cast<double>(pooled_pixel_count(probability, mask));
}

class DalyVdp : public Metric {
 public:
  DalyVdp(const DalySettings& settings, double p_threshold)
      : settings_(settings), p_threshold_(p_threshold) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    // Two statements, so that each picture's light is gone before the next step.
    Image reference = luminance_of(light_input(pair.reference, viewing).image());
    Image test = luminance_of(light_input(pair.test, viewing).image());
    Image map = daly_detection_map(std::move(reference), std::move(test), viewing.pixels_per_degree,
                                   settings_);
    const auto share = [&](double at_least) { return share_seen(map, pair.mask, at_least); };
    const MapExtremes extremes = map_extremes(map, pair.mask);
    VisibleRegions regions =
        visible_regions(map, pair.mask, static_cast<float>(p_threshold_), kMostRegions);
    Score score;
    score.value = share(p_threshold_);
    score.details = {{"p_mean", masked_mean(map, pair.mask)},
                     {"p_max", extremes.maximum},
                     {"p_max_x_px", static_cast<double>(extremes.max_x_px)},
                     {"p_max_y_px", static_cast<double>(extremes.max_y_px)},
                     {"share_50", share(0.50)},
                     {"share_75", share(0.75)},
                     {"share_95", share(0.95)},
                     {"visible_regions", static_cast<double>(regions.count)},
                     {"largest_region_pixels", static_cast<double>(regions.most_pixels)}};
    score.regions = std::move(regions.largest);
    score.map = std::move(map);
    return score;
  }

 private:
  DalySettings settings_;
  double p_threshold_;
};

std::vector<base::ParameterSpec> parameter_specs() {
  const DalySettings defaults;
  return {
      base::real_parameter("p_threshold", 0.75, {0.001, 0.999}, "",
                           "A pixel counts from this probability on; 0.75 is what the public VDP "
                           "programs report, beside 0.95."),
      base::real_parameter("luminance_cd_m2", defaults.luminance_cd_m2, {0.01, 10000.0}, "cd/m2",
                           "Adaptation of the CSF; contrasts about it keep their size."),
      base::real_parameter("area_deg2", defaults.area_deg2, {0.01, 10000.0}, "deg2",
                           "Size of the stimulus in the CSF."),
      base::real_parameter("distance_m", defaults.distance_m, {0.1, 10.0}, "m",
                           "Viewing distance in the CSF; pixels per degree are the viewing "
                           "conditions'."),
      base::real_parameter("slope", 0.0, {0.0, 1.0}, "",
                           "Slope of threshold elevation in every band, 0.65 learnt to 1 unlearnt "
                           "noise; 0: by band, 1 1 1 0.8 0.8 and 0.7 of the baseband."),
      base::boolean_parameter("phase_uncertainty", defaults.is_phase_uncertain,
                              "Smooths threshold elevation so that it does not follow the phase "
                              "of the mask."),
      base::real_parameter("uniform_sensitivity", defaults.uniform_sensitivity, {0.0, 1000.0}, "",
                           "Sensitivity to changes coarser than the baseband; 14 is TVI's 7.1 % "
                           "at 30 cd/m2; ours. 0: unseen, as in the paper's CSF."),
  };
}

DalySettings read_settings(const base::Parameters& parameters) {
  DalySettings settings;
  settings.luminance_cd_m2 = parameters.real("luminance_cd_m2");
  settings.area_deg2 = parameters.real("area_deg2");
  settings.distance_m = parameters.real("distance_m");
  const double slope = parameters.real("slope");
  if (slope > 0.0) settings.slope = slope;
  settings.is_phase_uncertain = parameters.boolean("phase_uncertainty");
  settings.uniform_sensitivity = parameters.real("uniform_sensitivity");
  return settings;
}

}  // namespace

MetricInfo daly_vdp_info() {
  MetricInfo info;
  info.name = "daly-vdp";
  info.summary =
      "Daly's Visible Differences Predictor: share of the pixels whose difference in display "
      "luminance is seen with a probability of at least p_threshold, from contrast sensitivity and "
      "masking in 31 channels of frequency and orientation. The map is the probability.";
  info.unit = "";
  info.source = "Daly 1993, The Visible Differences Predictor, in Digital Images and Human Vision";
  info.better = Better::lower;
  info.input = "absolute light";
  info.identical_value = 0.0;
  info.parameters = parameter_specs();
  info.map_unit = "";
  info.map_scale = {0.0, 1.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<DalyVdp>(read_settings(parameters), parameters.real("p_threshold"));
  };
  return info;
}

}  // namespace metrics
