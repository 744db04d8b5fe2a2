#include "results/html_report/color_bar.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/html_report/html_text.h"
#include "results/html_report/stage_bars.h"

namespace results::html_report {

namespace {

/// Powers of ten within a logarithmic scale; on a linear one multiples of 1, 2 or 5 x 10^k.
std::vector<double> ticks_of(const perception::MapScale& scale) {
  std::vector<double> ticks;
  if (scale.is_logarithmic) {
    constexpr double kSlack = 1e-9;
    const int last = static_cast<int>(std::floor(std::log10(scale.high) + kSlack));
    for (int e = static_cast<int>(std::ceil(std::log10(scale.low) - kSlack)); e <= last; ++e) {
      ticks.push_back(std::pow(10.0, e));
    }
    return ticks;
  }
  for (const double offset : axis_ticks(scale.high - scale.low)) {
    ticks.push_back(scale.low + offset);
  }
  return ticks;
}

}  // namespace

std::string color_bar_gradient() {
  constexpr int kStops = 32;
  std::string stops;
  for (int i = 0; i <= kStops; ++i) {
    const double position = static_cast<double>(i) / kStops;
    const auto color = perception::false_color(position);
    stops += fmt::format("<stop offset=\"{:.4f}\" stop-color=\"rgb({},{},{})\"/>", position,
                         std::lround(255.0F * color[0]), std::lround(255.0F * color[1]),
                         std::lround(255.0F * color[2]));
  }
  return "<svg width=\"0\" height=\"0\" class=\"definitions\" aria-hidden=\"true\"><defs>"
         "<linearGradient id=\"false-color\">" +
         stops + "</linearGradient></defs></svg>\n";
}

std::string color_bar(const perception::MapScale& scale) {
  // User units are pixels: the bar leaves room for the first and the last label.
  constexpr double kLeft = 24.0;
  constexpr double kWidth = 272.0;
  std::string ticks;
  for (const double value : ticks_of(scale)) {
    const double x = kLeft + kWidth * perception::scale_position(value, scale);
    ticks += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"12\" y2=\"17\"/>"
        "<text x=\"{0:.1f}\" y=\"29\">{1:g}</text>",
        x, value);
  }
  return fmt::format(
      "<svg class=\"color-bar\" width=\"320\" height=\"32\" viewBox=\"0 0 320 32\" role=\"img\" "
      "aria-label=\"colour scale from {} to {} {}\"><rect x=\"{}\" y=\"0\" width=\"{}\" "
      "height=\"12\" fill=\"url(#false-color)\"/>{}</svg><span class=\"unit\">{}{}</span>",
      base::format_significant(scale.low, 3), base::format_significant(scale.high, 3),
      escape(scale.unit), kLeft, kWidth, ticks, escape(scale.unit),
      scale.is_logarithmic ? " (logarithmic)" : "");
}

}  // namespace results::html_report
