#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "metrics/metric.h"

namespace metrics {

/// A line in shares of the image's width and height, so that images of other sizes measure the same
/// place. (0, 0) is the corner at the top left, (1, 1) that at the bottom right.
struct ImageLine {
  double from_x = 0.0, from_y = 0.5, to_x = 1.0, to_y = 0.5;
};

/// The parameters `from_x`, `from_y`, `to_x` and `to_y`; by default the middle row.
std::vector<base::ParameterSpec> line_parameters();

/// @param metric  name for the message @throws base::InputError for a line without length
ImageLine read_line(const base::Parameters& parameters, std::string_view metric);

/// A line in pixels, with centres at whole numbers.
struct LinePx {
  double x = 0.0, y = 0.0;              ///< where it starts
  double along_x = 1.0, along_y = 0.0;  ///< unit vector
  double length_px = 0.0;
};
LinePx line_in_pixels(const ImageLine& line, const Image& image);

struct ProfileSample {
  double distance_px = 0.0;  ///< from the line's start
  double value = 0.0;
};

/// Values along a line, four to a pixel at least, each the mean over `strip_px` points one pixel
/// apart across the line, centred on it. A point's value is bilinear between the pixels that take
/// part; samples of which no point is near such a pixel are left out.
/// @param image  one channel @param mask  null: every pixel takes part
std::vector<ProfileSample> line_profile(const Image& image, const Image* mask, const LinePx& line,
                                        int strip_px);

/// The way from one level to another.
struct Transition {
  double start_level = 0.0;  ///< mean of the first tenth of the line
  double end_level = 0.0;    ///< mean of the last tenth
  double begin_px = 0.0;     ///< where 10 % of the step are reached
  double end_px = 0.0;       ///< where 90 % are
  double width_px() const { return end_px - begin_px; }
  double middle_px() const { return 0.5 * (begin_px + end_px); }
  /// Share of the step that a value is away from the start level.
  double share(double value) const { return (value - start_level) / (end_level - start_level); }
};

/// The 10-90 % transition of a profile: the shortest stretch that leaves 10 % and arrives at 90 %,
/// linear between samples; the same on the way back. Nothing if an end of the line has no sample or
/// if the levels differ by less than 1 % of the larger one.
std::optional<Transition> find_transition(std::span<const ProfileSample> profile, double length_px);

}  // namespace metrics
