#include "results/history/history_output.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/parallel.h"

namespace results::history {

using nlohmann::ordered_json;

namespace {

constexpr std::size_t kSparklineWidth = 32;

std::string format_point(const Series& series, const Point& point) {
  return series.unit == "s" ? format_time(point.value) : format_score(point.value);
}

/// "- +12 % since 20261127T230000Z-5b4e99 (a3ff685)"
std::string format_step(const Trend& trend) {
  if (trend.steps.empty()) return "none";
  const Step& step = trend.steps.back();
  const Point& point = trend.series.points[step.at];
  const bool is_worse = (step.after > step.before) == (trend.series.better != Direction::higher);
  const std::string change =
      step.before > 0.0 && step.after > 0.0
          ? fmt::format("{:+.1f} %", 100.0 * (step.after / step.before - 1.0))
          : fmt::format("{:+.3g}", step.after - step.before);
  const std::string commit =
      point.commit.empty() ? "" : fmt::format(" ({})", point.commit.substr(0, 7));
  return fmt::format("{} {} since {}{}", is_worse ? "-" : "+", change, point.run, commit);
}

/// Of times and memory; of scores none: theirs is over seeds, which are the same in every run.
std::vector<ValueInterval> intervals_of(const Series& series) {
  std::vector<ValueInterval> intervals;
  if (series.unit != "s" && series.unit != "bytes") return intervals;
  for (const Point& point : series.points) intervals.push_back({point.value.low, point.value.high});
  return intervals;
}

TableCell words(std::string text) { return {std::move(text), std::nullopt, false, ""}; }

}  // namespace

Trend trend_of(Series series, double least_effect) {
  std::vector<double> values;
  for (const Point& point : series.points) values.push_back(point.value.value);
  std::vector<Step> steps = find_steps(values, least_effect, intervals_of(series));
  return {std::move(series), std::move(steps)};
}

std::vector<Trend> trends_of(std::vector<Series> series, double least_effect) {
  std::vector<Trend> trends(series.size());
  base::parallel_for(series.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      trends[i] = trend_of(std::move(series[i]), least_effect);
    }
  });
  return trends;
}

std::string sparkline(const Series& series, std::size_t width) {
  constexpr const char* kBars[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  constexpr double kTop = std::size(kBars) - 1;
  const auto& points = series.points;
  const std::size_t begin = points.size() > width ? points.size() - width : 0;
  if (points.empty()) return "";
  double low = points[begin].value.value;
  double high = low;
  for (std::size_t i = begin; i < points.size(); ++i) {
    low = std::min(low, points[i].value.value);
    high = std::max(high, points[i].value.value);
  }
  std::string line;
  for (std::size_t i = begin; i < points.size(); ++i) {
    const double share = high > low ? (points[i].value.value - low) / (high - low) : 0.5;
    line += kBars[static_cast<std::size_t>(std::lround(share * kTop))];
  }
  return line;
}

Table trend_table(const std::vector<Trend>& trends) {
  std::set<std::string> devices;
  for (const Trend& trend : trends) devices.insert(trend.series.device);
  Table table;
  for (const char* title : {"scene", "method", "budget"}) {
    table.columns.push_back({title, "", Direction::none, false});
  }
  if (devices.size() > 1) table.columns.push_back({"device", "", Direction::none, false});
  for (const char* title : {"runs", "first", "last"}) {
    table.columns.push_back({title, "", Direction::none, true});
  }
  table.columns.push_back({"trend", "", Direction::none, false});
  table.columns.push_back({"last step", "", Direction::none, false});
  for (const Trend& trend : trends) {
    const Series& series = trend.series;
    if (series.points.empty()) continue;
    std::vector<TableCell> row{words(series.scene), words(series.method), words(series.budget)};
    if (devices.size() > 1) row.push_back(words(series.device));
    row.push_back(words(std::to_string(series.points.size())));
    row.push_back(words(format_point(series, series.points.front())));
    row.push_back(words(format_point(series, series.points.back())));
    row.push_back(words(sparkline(series, kSparklineWidth)));
    row.push_back(words(format_step(trend)));
    table.rows.push_back(std::move(row));
  }
  table.notes.emplace_back(
      "last step: where the level changed, - for the worse; a level is at least two runs, so the "
      "newest run is judged by `discern compare`");
  return table;
}

ordered_json to_json(const std::vector<Trend>& trends) {
  ordered_json list = ordered_json::array();
  for (const Trend& trend : trends) {
    const Series& series = trend.series;
    ordered_json points = ordered_json::array();
    for (const Point& point : series.points) {
      points.push_back({{"run", point.run},
                        {"utc", point.utc},
                        {"commit", point.commit},
                        {"dirty", point.is_dirty},
                        {"value", point.value.value},
                        {"low", point.value.low},
                        {"high", point.value.high},
                        {"count", point.value.count}});
    }
    ordered_json steps = ordered_json::array();
    for (const Step& step : trend.steps) {
      steps.push_back({{"run", series.points[step.at].run},
                       {"commit", series.points[step.at].commit},
                       {"before", step.before},
                       {"after", step.after}});
    }
    list.push_back({{"scene", series.scene},
                    {"method", series.method},
                    {"budget", series.budget},
                    {"device", series.device},
                    {"unit", series.unit},
                    {"better", series.better == Direction::higher ? "higher" : "lower"},
                    {"points", std::move(points)},
                    {"steps", std::move(steps)}});
  }
  return list;
}

}  // namespace results::history
