#include "metrics/holes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "metrics/image_region.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "metrics/visible_regions.h"

namespace metrics {
namespace {

constexpr const char* kName = "holes";
/// A neighbourhood counts as at least this share of the mean luminance, so that nearly black pixels
/// are not compared with each other.
constexpr double kDarkestShare = 0.01;
constexpr std::size_t kMostRegions = 20;
constexpr int kLargestRadius_px = 64;

struct HoleSettings {
  int radius_px = 1;
  float threshold = 0.05F;
  ImageRegion region;
};

/// Extremes of the pixels around one.
struct Ring {
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -std::numeric_limits<float>::infinity();
};

Ring ring_around(const Image& luminance, int x, int y, int radius) {
  Ring ring;
  const auto add = [&](int at_x, int at_y) {
    if (at_x < 0 || at_y < 0 || at_x >= luminance.width_px || at_y >= luminance.height_px) return;
    const float value = std::max(luminance.at(at_x, at_y), 0.0F);
    ring.lowest = std::min(ring.lowest, value);
    ring.highest = std::max(ring.highest, value);
  };
  for (int i = -radius; i <= radius; ++i) {
    add(x + i, y - radius);
    add(x + i, y + radius);
  }
  for (int i = -radius + 1; i < radius; ++i) {
    add(x - radius, y + i);
    add(x + radius, y + i);
  }
  return ring;
}

/// How far a pixel sticks out of its ring, relative to the ring: above 0 for a peak, below 0 for a
/// dip, 0 for what is neither by more than the threshold.
float extremum(const Image& luminance, int x, int y, float darkest, const HoleSettings& settings) {
  const Ring ring = ring_around(luminance, x, y, settings.radius_px);
  if (ring.lowest > ring.highest) return 0.0F;
  const float value = std::max(luminance.at(x, y), 0.0F);
  const float above = value - ring.highest;
  const float below = ring.lowest - value;
  const float high = std::max(ring.highest, darkest);
  const float low = std::max(ring.lowest, darkest);
  if (above > settings.threshold * high) return above / high;
  if (below > settings.threshold * low) return -below / low;
  return 0.0F;
}

float darkest_neighbourhood(const Image& reference, const Image& test, const Image* mask) {
  const double mean = masked_mean(reference, mask);
  return static_cast<float>(kDarkestShare *
                            std::max(mean > 0.0 ? mean : masked_mean(test, mask), 0.0));
}

/// Holes by how far they stick out: of the test alone, and extrema of the reference.
struct HoleMaps {
  Image bright, dark, reference;
};

HoleMaps find_holes(const Image& reference, const Image& test, float darkest,
                    const HoleSettings& settings) {
  const Image empty = perception::make_gray_image(test.width_px, test.height_px, "holes",
                                                  perception::Encoding::scene_linear);
  HoleMaps maps{empty, empty, empty};
  for_each_row(test.height_px, [&](int y) {
    for (int x = 0; x < test.width_px; ++x) {
      const float expected = extremum(reference, x, y, darkest, settings);
      const float found = extremum(test, x, y, darkest, settings);
      maps.reference.at(x, y) = std::abs(expected);
      if (found > 0.0F && expected <= 0.0F) maps.bright.at(x, y) = found;
      if (found < 0.0F && expected >= 0.0F) maps.dark.at(x, y) = -found;
    }
  });
  return maps;
}

class Holes : public Metric {
 public:
  explicit Holes(HoleSettings settings) : settings_(settings) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions&) const override {
    const Image reference = linear_luminance(pair.reference, kName);
    const Image test = linear_luminance(pair.test, kName);
    const Image mask = region_mask(settings_.region, reference, pair.mask, kName);
    HoleMaps maps =
        find_holes(reference, test, darkest_neighbourhood(reference, test, pair.mask), settings_);
    const double bright = masked_share_above(maps.bright, &mask, 0.0F);
    const double dark = masked_share_above(maps.dark, &mask, 0.0F);
    Score score;
    score.map = std::move(maps.bright);
    for_each_pixel(*score.map, [&](std::size_t i) {
      score.map->pixels[i] = std::max(score.map->pixels[i], maps.dark.pixels[i]);
    });
    score.value = masked_share_above(*score.map, &mask, 0.0F);
    VisibleRegions regions = visible_regions(*score.map, &mask, 0.0F, kMostRegions);
    score.details = {{"bright", bright},
                     {"dark", dark},
                     {"pixels", score.value * static_cast<double>(pooled_pixel_count(mask, &mask))},
                     {"connected", static_cast<double>(regions.count)},
                     {"largest", map_extremes(*score.map, &mask).maximum},
                     {"reference", masked_share_above(maps.reference, &mask, 0.0F)}};
    score.regions = std::move(regions.largest);
    return score;
  }

 private:
  HoleSettings settings_;
};

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = {
      base::real_parameter("threshold", 0.05, {0.0, 1.0}, "",
                           "How far a pixel must be above or below its neighbourhood, relative to "
                           "that; ours."),
      base::integer_parameter(
          "radius", 1, {1.0, kLargestRadius_px}, "px",
          "Distance of the neighbourhood's ring; spots of up to radius x radius "
          "pixels count wholly; ours: single pixels.")};
  for (base::ParameterSpec& one : region_parameters()) specs.push_back(std::move(one));
  return specs;
}

}  // namespace

MetricInfo holes_info() {
  MetricInfo info;
  info.name = kName;
  info.summary =
      "Share of the pixels whose luminance is more than the threshold above or below all of their "
      "neighbourhood, and is not so in the reference.";
  info.source = "ours";
  info.better = Better::lower;
  info.input = "scene-linear RGB";
  info.identical_value = 0.0;
  info.parameters = parameter_specs();
  info.map_unit = "relative to the neighbourhood";
  info.map_scale = {0.0, 1.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<Holes>(HoleSettings{static_cast<int>(parameters.integer("radius")),
                                                static_cast<float>(parameters.real("threshold")),
                                                read_region(parameters, kName)});
  };
  return info;
}

}  // namespace metrics
