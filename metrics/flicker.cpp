#include "metrics/flicker.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "metrics/visible_bands.h"
#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "perception/threshold_map.h"

namespace metrics {
namespace {

void require_same_size(const Image& frame, const char* name, std::size_t index,
                       const Image& first) {
  if (frame.has_size_of(first)) return;
  throw base::InputError(fmt::format(
      "metric \"flicker\": {} {} is {}x{} pixels, the first reference frame {}x{}; accepted: one "
      "size",
      name, index, frame.width_px, frame.height_px, first.width_px, first.height_px));
}

void check(const SequencePair& pair) {
  if (pair.reference.empty()) {
    throw base::InputError("metric \"flicker\": no frames; accepted: at least one");
  }
  if (pair.reference.size() != pair.test.size()) {
    throw base::InputError(
        fmt::format("metric \"flicker\": {} reference frames and {} test frames; accepted: equal "
                    "numbers",
                    pair.reference.size(), pair.test.size()));
  }
  const Image& first = pair.reference.front();
  for (std::size_t t = 0; t < pair.reference.size(); ++t) {
    require_same_size(pair.reference[t], "reference frame", t, first);
    require_same_size(pair.test[t], "test frame", t, first);
  }
  if (pair.mask == nullptr) return;
  require_same_size(*pair.mask, "mask", 0, first);
  if (pair.mask->channel_count() != 1 || pooled_pixel_count(first, pair.mask) == 0) {
    throw base::InputError(
        "metric \"flicker\": the mask leaves no pixel or has several channels; accepted: one "
        "channel with at least one 1");
  }
}

Image luminance_frame(const Image& frame, const ViewingConditions& viewing) {
  return luminance_of(light_input(frame, viewing).image());
}

/// Luminance of a frame of both sequences.
struct FrameLight {
  Image reference;
  Image test;
};

class Flicker : public SequenceMetric {
 public:
  explicit Flicker(perception::ThresholdSettings settings) : settings_(std::move(settings)) {}

  int history_frames() const override { return 1; }

  std::vector<Score> evaluate(const SequencePair& pair,
                              const ViewingConditions& viewing) const override {
    check(pair);
    std::vector<Score> scores;
    FrameLight last;
    for (std::size_t t = 0; t < pair.reference.size(); ++t) {
      FrameLight now{luminance_frame(pair.reference[t], viewing),
                     luminance_frame(pair.test[t], viewing)};
      if (t > 0) scores.push_back(frame_score(last, now, pair.mask, viewing));
      last = std::move(now);
    }
    return scores;
  }

 private:
  Score frame_score(const FrameLight& last, const FrameLight& now, const Image* mask,
                    const ViewingConditions& viewing) const {
    const perception::ThresholdMap thresholds =
        perception::threshold_map(last.reference, now.reference, viewing, settings_);
    Score score;
    score.map = perception::make_gray_image(now.test.width_px, now.test.height_px, "jnd",
                                            perception::Encoding::scene_linear);
    for_each_row(score.map->height_px, [&](int y) {
      const std::size_t begin = score.map->offset(0, y);
      const std::size_t end = begin + static_cast<std::size_t>(score.map->width_px);
      for (std::size_t i = begin; i < end; ++i) {
        const float change = now.test.pixels[i] - last.test.pixels[i];
        const float expected = now.reference.pixels[i] - last.reference.pixels[i];
        score.map->pixels[i] = std::abs(change - expected) / thresholds.threshold_cd_m2.pixels[i];
      }
    });
    score.value = masked_mean(*score.map, mask);
    score.non_finite_pixels = perception::count_non_finite(*score.map).pixels;
    const MapExtremes extremes = map_extremes(*score.map, mask);
    score.details = {{"visible", visible_share(*score.map, mask)},
                     {"jnd_p95", masked_quantile(*score.map, mask, 0.95)},
                     {"jnd_max", extremes.maximum},
                     {"jnd_max_x_px", static_cast<double>(extremes.max_x_px)},
                     {"jnd_max_y_px", static_cast<double>(extremes.max_y_px)}};
    return score;
  }

  static double visible_share(const Image& map, const Image* mask) {
    const double visible = sum_over_rows(map.height_px, [&](int y) {
      double row = 0.0;
      for (int x = 0; x < map.width_px; ++x) {
        if (takes_part(mask, map.offset(x, y)) && map.at(x, y) > 1.0F) row += 1.0;
      }
      return row;
    });
    return visible / static_cast<double>(pooled_pixel_count(map, mask));
  }

  perception::ThresholdSettings settings_;
};

perception::ThresholdSettings read_settings(const base::Parameters& parameters) {
  const VisibilitySettings visibility =
      visibility_settings(VisibilityModel::joint, base::kebab_case(parameters.text("csf")),
                          parameters.text("tvi"), parameters.real("tvi_scale"));
  perception::ThresholdSettings settings;
  settings.curve = visibility.curve;
  settings.threshold_scale = visibility.tvi_scale;
  settings.masking = visibility.masking;
  return settings;
}

}  // namespace

SequenceMetricInfo flicker_info() {
  SequenceMetricInfo info;
  info.name = "flicker";
  info.summary =
      "Mean change of display luminance from frame to frame beyond the reference's own change, in "
      "thresholds of the reference.";
  info.unit = "JND";
  info.source = "ours; thresholds after Ramasubramanian et al. 1999, doi:10.1145/311535.311543";
  info.better = Better::lower;
  info.input = "absolute light";
  info.identical_value = 0.0;
  info.parameters = visibility_parameters();
  info.shares_model_with = {"grid-final-gather"};
  info.map_unit = info.unit;
  info.map_scale = {0.0, 5.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<SequenceMetric> {
    return std::make_unique<Flicker>(read_settings(parameters));
  };
  return info;
}

}  // namespace metrics
