#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace results::html_report {

struct ChartPoint {
  double x = 0.0;
  double y = 0.0;       ///< a value that is not finite leaves a gap
  double spread = 0.0;  ///< half the length of an error bar
};

struct ChartLine {
  std::string label;
  std::size_t color = 0;           ///< lines of one colour belong together on a page
  std::vector<ChartPoint> points;  ///< by x
  bool is_bold = false;            ///< what the others are compared with
};

/// Lines over frames, or over another whole or logarithmic axis.
struct FrameChart {
  std::string title;
  std::string unit;  ///< of y; "" if it has none
  std::string x_title = "frame";
  /// Places of x with names of their own, shown instead of numbers.
  std::vector<std::pair<double, std::string>> x_names;
  bool is_log_x = false;       ///< x is shown by its logarithm; points at 0 and below have no place
  bool starts_at_zero = true;  ///< the y axis; else at the lowest value
  std::vector<ChartLine> lines;
  std::optional<std::pair<double, double>> x_range;  ///< of the x axis; else that of the points
  std::function<std::string(double)> format;         ///< of a y value
};

/// A picture with axes (SVG); every point tells its values. "" if no value is finite.
std::string frame_chart(const FrameChart& chart);

/// Colours and names of lines.
std::string line_legend(const std::vector<ChartLine>& lines);

}  // namespace results::html_report
