#include "metrics/leak.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "metrics/image_region.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"

namespace metrics {
namespace {

constexpr const char* kName = "leak";

/// a / b, NaN for a divisor that is not above 0.
double ratio_or_nan(double a, double b) { return b > 0.0 ? a / b : std::nan(""); }

/// Means over the pixels of a region.
struct LeakMeans {
  double leak = 0.0, dark = 0.0, reference = 0.0, test = 0.0;
};

class Leak : public Metric {
 public:
  Leak(double dark, const ImageRegion& region) : dark_(dark), region_(region) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions&) const override {
    const Image reference = linear_luminance(pair.reference, kName);
    const Image test = linear_luminance(pair.test, kName);
    const Image mask = region_mask(region_, reference, pair.mask, kName);
    const double image_mean = masked_mean(reference, pair.mask);
    const auto darkest = static_cast<float>(dark_ * std::max(image_mean, 0.0));
    Score score;
    score.map = perception::make_gray_image(reference.width_px, reference.height_px, "leak",
                                            perception::Encoding::scene_linear);
    Image is_dark = *score.map;
    for_each_pixel(reference, [&](std::size_t i) {
      if (reference.pixels[i] > darkest) return;
      is_dark.pixels[i] = 1.0F;
      score.map->pixels[i] = std::max(test.pixels[i] - reference.pixels[i], 0.0F);
    });
    const LeakMeans means{masked_mean(*score.map, &mask), masked_mean(is_dark, &mask),
                          masked_mean(reference, &mask), masked_mean(test, &mask)};
    const double share_of_image = static_cast<double>(pooled_pixel_count(mask, &mask)) /
                                  static_cast<double>(pooled_pixel_count(reference, pair.mask));
    score.value = means.leak > 0.0 ? ratio_or_nan(means.leak, image_mean) : 0.0;
    score.details = {{"leaked_share", score.value * share_of_image},
                     {"dark_share", means.dark},
                     {"dark_mean", means.dark > 0.0 ? score.value / means.dark : 0.0},
                     {"energy_error", ratio_or_nan(means.test - means.reference, means.reference)},
                     {"reference_mean", image_mean}};
    const float scale = image_mean > 0.0 ? static_cast<float>(1.0 / image_mean) : 0.0F;
    for_each_pixel(*score.map, [&](std::size_t i) { score.map->pixels[i] *= scale; });
    return score;
  }

 private:
  double dark_;
  ImageRegion region_;
};

}  // namespace

MetricInfo leak_info() {
  MetricInfo info;
  info.name = kName;
  info.summary =
      "Light where the reference has none: mean over the region of max(0, x - r) at pixels whose "
      "reference luminance r is at most a share of its mean, over that mean.";
  info.source = "ours";
  info.better = Better::lower;
  info.input = "scene-linear RGB";
  info.identical_value = 0.0;
  info.parameters = {base::real_parameter(
      "dark", 0.01, {0.0, 1.0}, "",
      "Largest luminance of a pixel without light, as a share of the reference's mean; ours.")};
  for (base::ParameterSpec& one : region_parameters()) info.parameters.push_back(std::move(one));
  info.map_unit = "mean luminances";
  info.map_scale = {0.0, 1.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<Leak>(parameters.real("dark"), read_region(parameters, kName));
  };
  return info;
}

}  // namespace metrics
