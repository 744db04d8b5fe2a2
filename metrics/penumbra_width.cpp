#include "metrics/penumbra_width.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "metrics/line_profile.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"

namespace metrics {
namespace {

constexpr const char* kName = "penumbra-width";
constexpr int kWidestStrip_px = 1000;

/// What one image shows along the line.
struct Border {
  std::vector<ProfileSample> profile;
  std::optional<Transition> transition;
  double width_px() const { return transition ? transition->width_px() : std::nan(""); }
  double middle_px() const { return transition ? transition->middle_px() : std::nan(""); }
  double step() const {
    return transition ? std::abs(transition->end_level - transition->start_level) : std::nan("");
  }
};

Border border_of(const Image& luminance, const Image* mask, const LinePx& line, int strip_px) {
  Border border;
  border.profile = line_profile(luminance, mask, line, strip_px);
  border.transition = find_transition(border.profile, line.length_px);
  return border;
}

/// Share of the step at the sample next to a place on the line.
double share_at(const Border& border, double distance_px) {
  const auto next = std::lower_bound(
      border.profile.begin(), border.profile.end(), distance_px,
      [](const ProfileSample& sample, double distance) { return sample.distance_px < distance; });
  const auto found = next == border.profile.end() ? next - 1 : next;
  return border.transition->share(found->value);
}

/// |difference of the shares of the step| on the strip's pixels, 0 elsewhere.
Image strip_map(const Image& like, const LinePx& line, int strip_px, const Border& reference,
                const Border& test) {
  Image map = perception::make_gray_image(like.width_px, like.height_px, "difference",
                                          perception::Encoding::scene_linear);
  if (!reference.transition || !test.transition) return map;
  for_each_row(map.height_px, [&](int y) {
    for (int x = 0; x < map.width_px; ++x) {
      const double from_x = x - line.x;
      const double from_y = y - line.y;
      const double along = from_x * line.along_x + from_y * line.along_y;
      const double across = from_y * line.along_x - from_x * line.along_y;
      if (along < 0.0 || along > line.length_px || std::abs(across) > 0.5 * strip_px) continue;
      map.at(x, y) =
          static_cast<float>(std::abs(share_at(test, along) - share_at(reference, along)));
    }
  });
  return map;
}

class PenumbraWidth : public Metric {
 public:
  PenumbraWidth(const ImageLine& line, int strip_px) : line_(line), strip_px_(strip_px) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions&) const override {
    const LinePx line = line_in_pixels(line_, pair.reference);
    const Border reference =
        border_of(linear_luminance(pair.reference, kName), pair.mask, line, strip_px_);
    const Border test = border_of(linear_luminance(pair.test, kName), pair.mask, line, strip_px_);
    Score score;
    score.value = std::abs(std::log2(test.width_px()) - std::log2(reference.width_px()));
    score.details = {{"width_px", test.width_px()},
                     {"reference_width_px", reference.width_px()},
                     {"ratio", test.width_px() / reference.width_px()},
                     {"shift_px", test.middle_px() - reference.middle_px()},
                     {"step", test.step()},
                     {"reference_step", reference.step()},
                     {"line_px", line.length_px}};
    score.map = strip_map(pair.reference, line, strip_px_, reference, test);
    return score;
  }

 private:
  ImageLine line_;
  int strip_px_;
};

}  // namespace

MetricInfo penumbra_width_info() {
  MetricInfo info;
  info.name = kName;
  info.summary =
      "|log2(w / reference's w)|, w being the width in pixels of the transition from 10 to 90 % "
      "of the step in luminance along a line; n/a without a transition.";
  info.unit = "octaves";
  info.source = "ours";
  info.better = Better::lower;
  info.input = "scene-linear RGB";
  info.identical_value = 0.0;
  info.parameters = line_parameters();
  info.parameters.push_back(base::integer_parameter(
      "strip", 5, {1.0, kWidestStrip_px}, "px",
      "Width of the strip across the line over which each place is averaged; ours."));
  info.map_unit = "share of the step";
  info.map_scale = {0.0, 1.0, false, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<PenumbraWidth>(read_line(parameters, kName),
                                           static_cast<int>(parameters.integer("strip")));
  };
  return info;
}

}  // namespace metrics
