#include "results/html_report/frame_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "results/html_report/html_text.h"
#include "results/html_report/stage_bars.h"

namespace results::html_report {

namespace {

// Places in the picture, in its own units.
constexpr double kWidth = 620.0;
constexpr double kHeight = 240.0;
constexpr double kLeft = 70.0;
constexpr double kRight = 12.0;
constexpr double kTop = 10.0;
constexpr double kBottom = 36.0;
/// The style sheet has so many line colours; then they begin again.
constexpr std::size_t kColors = 8;
/// Room above and below values that do not start at zero, as a part of their span.
constexpr double kMargin = 0.08;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// Wider where it has no width, so that values have a place in it.
  void widen(double least) {
    if (high - low >= least) return;
    low -= 0.5 * least;
    high += 0.5 * least;
  }
};

/// Where values of x and y go.
struct Axes {
  Range x;  ///< of the logarithm, if the axis is logarithmic
  Range y;
  bool is_log_x = false;
  double along_x(double value) const { return is_log_x ? std::log10(value) : value; }
  bool has_place(const ChartPoint& point) const { return !is_log_x || point.x > 0.0; }
  double place_x(double value) const {
    return kLeft + (along_x(value) - x.low) / (x.high - x.low) * (kWidth - kLeft - kRight);
  }
  double place_y(double value) const {
    return kHeight - kBottom - (value - y.low) / (y.high - y.low) * (kHeight - kTop - kBottom);
  }
};

std::optional<Axes> axes_of(const FrameChart& chart) {
  Axes axes;
  axes.is_log_x = chart.is_log_x;
  bool has_value = false;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) {
      if (!axes.has_place(point)) continue;
      axes.x.add(axes.along_x(point.x));
      if (!std::isfinite(point.y)) continue;
      axes.y.add(point.y - point.spread);
      axes.y.add(point.y + point.spread);
      has_value = true;
    }
  }
  if (!has_value) return std::nullopt;
  if (chart.x_range) {
    axes.x.add(axes.along_x(chart.x_range->first));
    axes.x.add(axes.along_x(chart.x_range->second));
  }
  axes.x.widen(chart.is_log_x ? 0.1 : 1.0);
  const double span = axes.y.high - axes.y.low;
  if (chart.starts_at_zero && axes.y.low >= 0.0) {
    axes.y.low = 0.0;
  } else {
    axes.y.low -= kMargin * span;
  }
  axes.y.high += kMargin * span;
  axes.y.widen(1e-6 + 1e-3 * std::abs(axes.y.high));
  return axes;
}

/// Round values of a range, a few of them.
std::vector<double> ticks_of(const Range& range, double least_step) {
  const std::vector<double> from_zero = axis_ticks(range.high - range.low);
  const double step = std::max(from_zero.size() > 1 ? from_zero[1] : 1.0, least_step);
  std::vector<double> ticks;
  for (double i = std::ceil(range.low / step); i * step <= range.high; i += 1.0) {
    ticks.push_back(i * step);
  }
  return ticks;
}

/// 1, 2 and 5 times powers of ten of a range of logarithms; powers alone where that is many.
std::vector<double> log_ticks(const Range& logs) {
  constexpr double kMostDecades = 3.0;
  std::vector<double> ticks;
  for (double power = std::floor(logs.low); power <= logs.high; power += 1.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, power);
      const double place = std::log10(tick);
      const bool is_shown = factor == 1.0 || logs.high - logs.low <= kMostDecades;
      if (is_shown && place >= logs.low && place <= logs.high) ticks.push_back(tick);
    }
  }
  return ticks;
}

std::vector<std::pair<double, std::string>> x_ticks(const FrameChart& chart, const Axes& axes) {
  if (!chart.x_names.empty()) return chart.x_names;
  std::vector<std::pair<double, std::string>> ticks;
  for (const double tick : chart.is_log_x ? log_ticks(axes.x) : ticks_of(axes.x, 1.0)) {
    ticks.emplace_back(tick, fmt::format("{:g}", tick));
  }
  return ticks;
}

std::string grid(const FrameChart& chart, const Axes& axes) {
  std::string svg;
  for (const double tick : ticks_of(axes.y, 0.0)) {
    const double y = axes.place_y(tick);
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
        "<text x=\"{}\" y=\"{:.1f}\" class=\"y\">{}</text>",
        kLeft, kWidth - kRight, y, y, kLeft - 6.0, y + 3.5, escape(chart.format(tick)));
  }
  for (const auto& [place, name] : x_ticks(chart, axes)) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" class=\"x\">{}</text>", axes.place_x(place),
                       kHeight - kBottom + 15.0, escape(name));
  }
  return svg + fmt::format("<text x=\"{}\" y=\"{}\" class=\"x\">{}</text>",
                           0.5 * (kLeft + kWidth - kRight), kHeight - 5.0, escape(chart.x_title));
}

std::string with_unit(const FrameChart& chart, double value) {
  return chart.format(value) + (chart.unit.empty() ? "" : " " + chart.unit);
}

std::string line_of(const FrameChart& chart, const ChartLine& line, const Axes& axes) {
  std::string path;
  std::string points;
  bool is_after_gap = true;
  for (const ChartPoint& point : line.points) {
    if (!std::isfinite(point.y) || !axes.has_place(point)) {
      is_after_gap = true;
      continue;
    }
    const double x = axes.place_x(point.x);
    const double y = axes.place_y(point.y);
    path += fmt::format("{}{:.1f} {:.1f}", is_after_gap ? "M" : "L", x, y);
    is_after_gap = false;
    if (point.spread > 0.0) {
      path += fmt::format("M{:.1f} {:.1f}V{:.1f}M{:.1f} {:.1f}", x,
                          axes.place_y(point.y - point.spread),
                          axes.place_y(point.y + point.spread), x, y);
    }
    points += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\"><title>{}, {} {:g}: "
        "{}</title></circle>",
        x, y, escape(line.label), escape(chart.x_title), point.x,
        escape(with_unit(chart, point.y)));
  }
  return fmt::format("<g class=\"line-{}{}\"><path d=\"{}\"/>{}</g>", line.color % kColors,
                     line.is_bold ? " bold" : "", path, points);
}

}  // namespace

std::string frame_chart(const FrameChart& chart) {
  const std::optional<Axes> axes = axes_of(chart);
  if (!axes) return "";
  std::string svg = fmt::format(
      "<figure class=\"frame-chart\"><figcaption><b>{}</b>{}</figcaption>"
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} per {}\">{}",
      escape(chart.title),
      chart.unit.empty() ? "" : fmt::format("<span>{}</span>", escape(chart.unit)), kWidth, kHeight,
      escape(chart.title), escape(chart.x_title), grid(chart, *axes));
  for (const ChartLine& line : chart.lines) svg += line_of(chart, line, *axes);
  return svg + "</svg></figure>\n";
}

std::string line_legend(const std::vector<ChartLine>& lines) {
  std::string items;
  for (const ChartLine& line : lines) {
    items += fmt::format("<span><i class=\"swatch line-{}\"></i>{}</span>", line.color % kColors,
                         escape(line.label));
  }
  return "<div class=\"legend\">" + items + "</div>\n";
}

}  // namespace results::html_report
