#include "results/html_report/trend_line.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "perception/base/quantile.h"
#include "perception/base/units.h"
#include "results/html_report/html_text.h"

namespace results::html_report {

namespace {

using history::Point;
using history::Series;
using history::Step;
using history::Trend;

// Places in the picture, in its own units.
constexpr double kWidth = 320.0;
constexpr double kHeight = 48.0;
constexpr double kMargin = 5.0;
constexpr std::size_t kShortCommit = 7;
/// Points of longer series would run together; their line and steps stay.
constexpr std::size_t kMostDots = 80;

class TrendLine {
 public:
  TrendLine(const Trend& trend, const RunPlaces& places) : trend_(trend), places_(places) {
    std::vector<double> values;
    for (const Point& point : trend.series.points) values.push_back(point.value.value);
    const double middle = base::median(values);
    low_ = std::ranges::min(values);
    high_ = std::ranges::max(values);
    const double least = kLeastSpan * std::abs(middle);
    low_ = std::min(low_, middle - least);
    high_ = std::max(high_, middle + least);
    if (high_ <= low_) high_ = low_ + 1.0;  // all of them are 0
  }

  std::string svg() const {
    return fmt::format(
        "<svg class=\"trend-line\" viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\" "
        "aria-label=\"{}\">{}{}{}{}</svg>",
        kWidth, kHeight, kWidth, kHeight, escape(summary()), band(), levels(), path(), dots());
  }

 private:
  double x(std::size_t i) const {
    const double last = std::max<double>(1.0, static_cast<double>(places_.size()) - 1.0);
    const auto place = static_cast<double>(places_.at(trend_.series.points[i].run));
    return kMargin + place / last * (kWidth - 2.0 * kMargin);
  }
  double y(double value) const {
    const double share = std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
    return kHeight - kMargin - share * (kHeight - 2.0 * kMargin);
  }

  std::string summary() const {
    const Series& series = trend_.series;
    return fmt::format("{} runs from {} to {}, {} steps", series.points.size(),
                       trend_value(series.unit, series.points.front().value),
                       trend_value(series.unit, series.points.back().value), trend_.steps.size());
  }

  std::string path() const {
    std::string d;
    for (std::size_t i = 0; i < trend_.series.points.size(); ++i) {
      d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x(i),
                       y(trend_.series.points[i].value.value));
    }
    return "<path class=\"values\" d=\"" + d + "\"/>";
  }

  /// Intervals, one band.
  std::string band() const {
    const auto& points = trend_.series.points;
    if (points.size() < 2) return "";
    std::string d;
    for (std::size_t i = 0; i < points.size(); ++i) {
      d += fmt::format("{:.1f},{:.1f} ", x(i), y(points[i].value.high));
    }
    for (std::size_t i = points.size(); i-- > 0;) {
      d += fmt::format("{:.1f},{:.1f} ", x(i), y(points[i].value.low));
    }
    return "<polygon class=\"interval\" points=\"" + d + "\"/>";
  }

  /// A level from a step to the next, and the steps.
  std::string levels() const {
    std::string svg;
    const std::size_t last = trend_.series.points.size() - 1;
    for (std::size_t i = 0; i < trend_.steps.size(); ++i) {
      const Step& step = trend_.steps[i];
      const char* css = is_for_the_worse(trend_.series, step) ? "worse" : "better";
      const std::size_t end = i + 1 < trend_.steps.size() ? trend_.steps[i + 1].at : last;
      svg += fmt::format(
          "<path class=\"step {}\" d=\"M{:.1f} {}V{}\"><title>{}</title></path>"
          "<path class=\"level\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>",
          css, x(step.at), kMargin, kHeight - kMargin,
          escape(fmt::format("{} since {}", trend_change(step.before, step.after),
                             trend_.series.points[step.at].run)),
          x(step.at), y(step.after), x(end));
    }
    return svg;
  }

  std::string dots() const {
    const auto& points = trend_.series.points;
    std::string svg;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool is_last = i + 1 == points.size();
      if (points.size() > kMostDots && !is_last) continue;
      std::string commit = points[i].commit.substr(0, kShortCommit);
      if (points[i].is_dirty) commit += " with local changes";
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"><title>{}</title></circle>",
                         x(i), y(points[i].value.value), is_last ? 3.2 : 2.0,
                         escape(fmt::format("{}\n{} {}\n{}", points[i].run, points[i].utc, commit,
                                            trend_value(trend_.series.unit, points[i].value))));
    }
    return svg;
  }

  const Trend& trend_;
  const RunPlaces& places_;
  double low_ = 0.0;
  double high_ = 1.0;
};

}  // namespace

std::string trend_value(const std::string& unit, const Estimate& value) {
  if (unit == "s") return format_time(value);
  if (unit == "bytes") return base::format_bytes(value.value);
  return unit.empty() ? format_score(value) : format_score(value) + " " + unit;
}

std::string trend_change(double before, double after) {
  return before > 0.0 && after > 0.0 ? fmt::format("{:+.1f} %", 100.0 * (after / before - 1.0))
                                     : fmt::format("{:+.3g}", after - before);
}

bool is_for_the_worse(const history::Series& series, const history::Step& step) {
  return (step.after > step.before) == (series.better != Direction::higher);
}

std::string trend_line(const history::Trend& trend, const RunPlaces& places) {
  return trend.series.points.empty() ? "" : TrendLine(trend, places).svg();
}

}  // namespace results::html_report
