#include "metrics/contrast_kept.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "metrics/image_region.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "perception/base/errors.h"
#include "perception/base/quantile.h"

namespace metrics {
namespace {

constexpr const char* kName = "contrast-kept";
/// A smaller share of the surrounding level is no dip.
constexpr double kLeastDip = 0.01;

struct DipSettings {
  double surround = 0.9;
  double bottom = 0.02;
  ImageRegion region;
};

/// A shadow by the levels around and in it.
struct Dip {
  double surround = 0.0;
  double bottom = 0.0;
  double depth() const { return surround - bottom; }
};

Dip dip_of(const Image& luminance, const Image& mask, const DipSettings& settings) {
  std::vector<double> values;
  for (std::size_t i = 0; i < luminance.pixels.size(); ++i) {
    if (takes_part(&mask, i)) values.push_back(static_cast<double>(luminance.pixels[i]));
  }
  std::sort(values.begin(), values.end());
  return {base::quantile_of_sorted(values, settings.surround),
          base::quantile_of_sorted(values, settings.bottom)};
}

/// The difference of the images in dips of the reference, 0 outside the region.
Image difference_map(const Image& reference, const Image& test, const Image& mask, double depth) {
  Image map = perception::make_gray_image(reference.width_px, reference.height_px, "difference",
                                          perception::Encoding::scene_linear);
  const auto scale = static_cast<float>(1.0 / depth);
  for_each_pixel(map, [&](std::size_t i) {
    if (!takes_part(&mask, i)) return;
    map.pixels[i] = scale * std::abs(test.pixels[i] - reference.pixels[i]);
  });
  return map;
}

class ContrastKept : public Metric {
 public:
  explicit ContrastKept(DipSettings settings) : settings_(settings) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions&) const override {
    const Image reference = linear_luminance(pair.reference, kName);
    const Image test = linear_luminance(pair.test, kName);
    const Image mask = region_mask(settings_.region, reference, pair.mask, kName);
    const Dip expected = dip_of(reference, mask, settings_);
    const Dip found = dip_of(test, mask, settings_);
    const bool has_dip =
        expected.depth() > 0.0 && expected.depth() >= kLeastDip * expected.surround;
    const double kept = has_dip ? found.depth() / expected.depth() : std::nan("");
    Score score;
    score.value = std::abs(1.0 - kept);
    score.details = {{"kept", kept},
                     {"dip", found.depth()},
                     {"surround", found.surround},
                     {"reference_dip", expected.depth()},
                     {"reference_surround", expected.surround}};
    score.map = has_dip ? difference_map(reference, test, mask, expected.depth())
                        : perception::make_gray_image(mask.width_px, mask.height_px, "difference",
                                                      perception::Encoding::scene_linear);
    return score;
  }

 private:
  DipSettings settings_;
};

DipSettings read_settings(const base::Parameters& parameters) {
  const DipSettings settings{parameters.real("surround"), parameters.real("bottom"),
                             read_region(parameters, kName)};
  if (settings.bottom < settings.surround) return settings;
  throw base::InputError(
      fmt::format("metric \"{}\": bottom is {} and surround {}; accepted: bottom below surround",
                  kName, settings.bottom, settings.surround));
}

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = {
      base::real_parameter("surround", 0.9, {0.0, 1.0}, "",
                           "Quantile of luminance that is the level around the shadow; ours: "
                           "bright specks of up to a tenth of the region have no say."),
      base::real_parameter("bottom", 0.02, {0.0, 1.0}, "",
                           "Quantile of luminance that is the shadow's bottom; ours: shadows of "
                           "more than a fiftieth of the region are seen.")};
  for (base::ParameterSpec& one : region_parameters()) specs.push_back(std::move(one));
  return specs;
}

}  // namespace

MetricInfo contrast_kept_info() {
  MetricInfo info;
  info.name = kName;
  info.summary =
      "|1 - kept|, kept being the shadow's dip in luminance over the reference's dip, each from a "
      "high to a low quantile of the region.";
  info.source = "ours";
  info.better = Better::lower;
  info.input = "scene-linear RGB";
  info.identical_value = 0.0;
  info.parameters = parameter_specs();
  info.map_unit = "dips of the reference";
  info.map_scale = {0.0, 1.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<ContrastKept>(read_settings(parameters));
  };
  return info;
}

}  // namespace metrics
