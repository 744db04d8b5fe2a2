#include "metrics/visible_difference.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "metrics/edge_excess.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/visible_bands.h"
#include "metrics/visible_regions.h"
#include "perception/base/names.h"
#include "perception/tabulated_curve.h"
#include "perception/threshold_map.h"

namespace metrics {
namespace {

constexpr float kOneJnd = 1.0F;
constexpr std::size_t kMostRegions = 20;

struct NamedModel {
  const char* name;
  VisibilityModel model;
};
constexpr NamedModel kModels[] = {{"band_matched", VisibilityModel::band_matched},
                                  {"joint", VisibilityModel::joint},
                                  {"separate", VisibilityModel::separate},
                                  {"off", VisibilityModel::off}};

VisibilitySettings read_settings(const base::Parameters& parameters) {
  const std::string& text = parameters.text("masking");
  const auto* named = std::find_if(std::begin(kModels), std::end(kModels),
                                   [&](const NamedModel& one) { return text == one.name; });
  VisibilitySettings settings = visibility_settings(
      named->model, base::kebab_case(parameters.text("csf")), parameters.text("tvi"),
      parameters.real("tvi_scale"), parameters.real("csf_gain"));
  settings.masking.largest_elevation = parameters.real("largest_elevation");
  settings.masking.neutral_contrast = parameters.real("neutral_contrast");
  return settings;
}

/// Mean of value(pixel) over the pixels that take part.
template <typename Value>
double mean_of(const Image& map, const Image* mask, const Value& value) {
  const double sum = sum_over_rows(map.height_px, [&](int y) {
    double row = 0.0;
    for (int x = 0; x < map.width_px; ++x) {
      if (takes_part(mask, map.offset(x, y))) row += value(x, y);
    }
    return row;
  });
  return sum / static_cast<double>(pooled_pixel_count(map, mask));
}

double share_visible(const Image& jnd, const Image* mask) {
  return masked_share_above(jnd, mask, kOneJnd);
}

/// Mean probability of seeing a pixel's difference.
double mean_detection(const Image& jnd, const Image* mask) {
  static const perception::TabulatedCurve kProbability(
      [](double value) { return perception::detection_probability(value); });
  return mean_of(jnd, mask, [&](int x, int y) -> double { return kProbability(jnd.at(x, y)); });
}

/// Share of pixels with a step to the right or down that is above a spot's threshold in the test
/// image and not in the reference.
double edge_excess(const Image& reference, const Image& test, const Image& spot_cd_m2,
                   const Image* mask) {
  return mean_of(reference, mask, [&](int x, int y) {
    return excess_step(reference, test, spot_cd_m2, x, y) > 0.0F ? 1.0 : 0.0;
  });
}

class VisibleDifference : public Metric {
 public:
  explicit VisibleDifference(VisibilitySettings settings) : settings_(std::move(settings)) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const Image reference = luminance_of(light_input(pair.reference, viewing).image());
    const Image test = luminance_of(light_input(pair.test, viewing).image());
    VisibilityMaps maps = visibility_maps(reference, test, viewing.pixels_per_degree, settings_);
    Score score;
    score.value = share_visible(maps.jnd, pair.mask);
    VisibleRegions regions = visible_regions(maps.jnd, pair.mask, kOneJnd, kMostRegions);
    const MapExtremes extremes = map_extremes(maps.jnd, pair.mask);
    score.details = {{"tvi", share_visible(maps.step_jnd, pair.mask)},
                     {"tvi_csf", share_visible(maps.unmasked_jnd, pair.mask)},
                     {"jnd_mean", masked_mean(maps.jnd, pair.mask)},
                     {"jnd_p95", masked_quantile(maps.jnd, pair.mask, 0.95)},
                     {"jnd_max", extremes.maximum},
                     {"jnd_max_x_px", static_cast<double>(extremes.max_x_px)},
                     {"jnd_max_y_px", static_cast<double>(extremes.max_y_px)},
                     {"p_detect", mean_detection(maps.jnd, pair.mask)},
                     {"edge_excess", edge_excess(reference, test, maps.spot_cd_m2, pair.mask)},
                     {"visible_regions", static_cast<double>(regions.count)},
                     {"largest_region_pixels", static_cast<double>(regions.most_pixels)},
                     {"tvi_scale", settings_.tvi_scale}};
    score.regions = std::move(regions.largest);
    score.map = std::move(maps.jnd);
    return score;
  }

 private:
  VisibilitySettings settings_;
};

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = visibility_parameters();
  specs.push_back(base::choice_parameter(
      "masking", {"band_matched", "joint", "separate", "off"}, "band_matched",
      "Thresholds by octaves of the difference (ours), one threshold per "
      "pixel by a weighted mean, the same in two factors, or no masking."));
  specs.push_back(
      base::real_parameter("csf_gain", 1.0, {1e-4, 1e4}, "",
                           "Multiplies sensitivity; by pixels only where contrast masks; ours."));
  specs.push_back(base::real_parameter(
      "neutral_contrast", 0.0, {0.0, 10.0}, "",
      "By pixels only: contrast of content that hides nothing, added to the mean over the octaves, "
      "so that elevation goes to 1 with contrast; ours."));
  specs.push_back(base::real_parameter(
      "largest_elevation", 10.0, {1.0, 1000.0}, "",
      "Most that masking (by pixels: CSF and masking) raises a threshold; Yee's code."));
  return specs;
}

}  // namespace

MetricInfo visible_difference_info() {
  MetricInfo info;
  info.name = "visible-difference";
  info.summary =
      "Fraction of the pixels whose difference in display luminance is above 1 JND, the product of "
      "TVI, contrast sensitivity and masking by what both images show.";
  info.unit = "";
  info.source = "after Ramasubramanian, Pattanaik, Greenberg 1999, doi:10.1145/311535.311543";
  info.better = Better::lower;
  info.input = "absolute light";
  info.identical_value = 0.0;
  info.parameters = parameter_specs();
  info.shares_model_with = {"grid-final-gather"};
  info.map_unit = "JND";
  info.map_scale = {0.0, 5.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<VisibleDifference>(read_settings(parameters));
  };
  return info;
}

}  // namespace metrics
