#include "metrics/line_profile.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "metrics/score_pooling.h"
#include "perception/base/errors.h"

namespace metrics {
namespace {

/// Samples meet the pixels' centres, where bilinear values bend, on lines along rows and columns.
constexpr double kSamplesPerPixel = 4.0;
constexpr double kEndShare = 0.1;    ///< of the line at each end that shows a level
constexpr double kLeastStep = 0.01;  ///< of the larger level; less is no transition
constexpr double kLow = 0.1, kHigh = 0.9;

/// A sum of values and the weight they have.
struct WeightedSum {
  double sum = 0.0, weight = 0.0;
};

/// Adds the bilinear value of a point.
void add_point(const Image& image, const Image* mask, double x, double y, WeightedSum& total) {
  const int left = static_cast<int>(std::floor(x));
  const int top = static_cast<int>(std::floor(y));
  for (int at_y = top; at_y <= top + 1; ++at_y) {
    for (int at_x = left; at_x <= left + 1; ++at_x) {
      if (at_x < 0 || at_y < 0 || at_x >= image.width_px || at_y >= image.height_px) continue;
      const std::size_t i = image.offset(at_x, at_y);
      if (!takes_part(mask, i)) continue;
      const double weight = (1.0 - std::abs(x - at_x)) * (1.0 - std::abs(y - at_y));
      total.sum += weight * static_cast<double>(image.pixels[i]);
      total.weight += weight;
    }
  }
}

/// Mean of the samples in a part of the line.
std::optional<double> mean_between(std::span<const ProfileSample> profile, double from_px,
                                   double to_px) {
  WeightedSum total;
  for (const ProfileSample& sample : profile) {
    if (sample.distance_px < from_px || sample.distance_px > to_px) continue;
    total.sum += sample.value;
    total.weight += 1.0;
  }
  if (total.weight == 0.0) return std::nullopt;
  return total.sum / total.weight;
}

/// Where the line between two samples has a share of the step.
double crossing_px(const Transition& step, const ProfileSample& a, const ProfileSample& b,
                   double share) {
  const double from = step.share(a.value);
  const double to = step.share(b.value);
  return a.distance_px + (share - from) / (to - from) * (b.distance_px - a.distance_px);
}

}  // namespace

std::vector<base::ParameterSpec> line_parameters() {
  return {base::real_parameter("from_x", 0.0, {0.0, 1.0}, "image widths",
                               "Where the line starts, on one side of the transition; ours: the "
                               "image's left side."),
          base::real_parameter("from_y", 0.5, {0.0, 1.0}, "image heights",
                               "Where the line starts, from the top; ours: half-way down."),
          base::real_parameter("to_x", 1.0, {0.0, 1.0}, "image widths",
                               "Where the line ends, on the other side of the transition; ours: "
                               "the image's right side."),
          base::real_parameter("to_y", 0.5, {0.0, 1.0}, "image heights",
                               "Where the line ends, from the top; ours: half-way down.")};
}

ImageLine read_line(const base::Parameters& parameters, std::string_view metric) {
  const ImageLine line{parameters.real("from_x"), parameters.real("from_y"),
                       parameters.real("to_x"), parameters.real("to_y")};
  if (line.from_x != line.to_x || line.from_y != line.to_y) return line;
  throw base::InputError(
      fmt::format("metric \"{}\": the line starts and ends at ({}, {}); accepted: two points",
                  metric, line.from_x, line.from_y));
}

LinePx line_in_pixels(const ImageLine& line, const Image& image) {
  LinePx px;
  px.x = line.from_x * image.width_px - 0.5;
  px.y = line.from_y * image.height_px - 0.5;
  const double x = (line.to_x - line.from_x) * image.width_px;
  const double y = (line.to_y - line.from_y) * image.height_px;
  px.length_px = std::hypot(x, y);
  px.along_x = x / px.length_px;
  px.along_y = y / px.length_px;
  return px;
}

std::vector<ProfileSample> line_profile(const Image& image, const Image* mask, const LinePx& line,
                                        int strip_px) {
  const int steps = std::max(1, static_cast<int>(std::ceil(kSamplesPerPixel * line.length_px)));
  std::vector<ProfileSample> profile;
  for (int i = 0; i <= steps; ++i) {
    const double distance = line.length_px * i / steps;
    WeightedSum total;
    for (int k = 0; k < strip_px; ++k) {
      const double across = k - 0.5 * (strip_px - 1);
      add_point(image, mask, line.x + distance * line.along_x - across * line.along_y,
                line.y + distance * line.along_y + across * line.along_x, total);
    }
    if (total.weight > 0.0) profile.push_back({distance, total.sum / total.weight});
  }
  return profile;
}

std::optional<Transition> find_transition(std::span<const ProfileSample> profile,
                                          double length_px) {
  const auto start = mean_between(profile, 0.0, kEndShare * length_px);
  const auto end = mean_between(profile, (1.0 - kEndShare) * length_px, length_px);
  if (!start || !end) return std::nullopt;
  const double step = std::abs(*end - *start);
  if (step == 0.0 || step < kLeastStep * std::max(std::abs(*start), std::abs(*end))) {
    return std::nullopt;
  }
  Transition shortest{*start, *end, 0.0, length_px};
  // The last way out of the low end before each arrival at the high one.
  std::optional<double> begin_px;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const double before = shortest.share(profile[i - 1].value);
    const double here = shortest.share(profile[i].value);
    if (before <= kLow && here > kLow) {
      begin_px = crossing_px(shortest, profile[i - 1], profile[i], kLow);
    }
    if (!begin_px || before >= kHigh || here < kHigh) continue;
    const double end_px = crossing_px(shortest, profile[i - 1], profile[i], kHigh);
    if (end_px - *begin_px >= shortest.width_px()) continue;
    shortest.begin_px = *begin_px;
    shortest.end_px = end_px;
  }
  return shortest;
}

}  // namespace metrics
