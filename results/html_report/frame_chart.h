#pragma once

#include <functional>
#include <string>
#include <vector>

namespace results::html_report {

struct ChartPoint {
  double x = 0.0;
  double y = 0.0;  ///< a value that is not finite leaves a gap
};

struct ChartLine {
  std::string label;
  std::size_t color = 0;           ///< lines of one colour belong together on a page
  std::vector<ChartPoint> points;  ///< by x
};

/// Lines over frames.
struct FrameChart {
  std::string title;
  bool starts_at_zero = true;  ///< the y axis; else at the lowest value
  std::vector<ChartLine> lines;
  std::function<std::string(double)> format;  ///< of a y value
};

/// A picture with axes (SVG); every point tells its values. "" if no value is finite.
std::string frame_chart(const FrameChart& chart);

/// Colours and names of lines.
std::string line_legend(const std::vector<ChartLine>& lines);

}  // namespace results::html_report
