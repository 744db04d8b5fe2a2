#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "metrics/metric_list.h"
#include "perception/base/names.h"
#include "perception/base/parameter_spec.h"
#include "perception/base/units.h"
#include "results/html_report/frame_chart.h"
#include "results/html_report/html_text.h"
#include "results/html_report/sections.h"

namespace results::html_report {

namespace {

/// A line per method, its colour the place of its row in the scene; methods without values have
/// none.
template <class PointsOf>
std::vector<ChartLine> lines_of(const ReportData& data, const SceneView& scene,
                                const PointsOf& points_of) {
  std::vector<ChartLine> lines;
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    ChartLine line{row_label(data, *scene.rows[i]), i, points_of(*scene.rows[i])};
    if (!line.points.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<ChartPoint> time_points(const SummaryRow& row) {
  std::vector<ChartPoint> points;
  for (const FrameTime& time : row.next_frames.frames) {
    points.push_back({static_cast<double>(time.frame), time.next_frame_s.value});
  }
  return points;
}

std::string time_chart(const ReportData& data, const SceneView& scene) {
  FrameChart chart;
  chart.title = "next frame";
  chart.lines = lines_of(data, scene, time_points);
  chart.format = [](double value) { return base::format_duration(value); };
  if (chart.lines.empty()) return "";
  return "<h3>Time per frame</h3>\n<p class=\"note\">update + render of every following frame, "
         "median over repetitions. The first frame, prepare + render, is in the tables.</p>\n" +
         line_legend(chart.lines) + "<div class=\"frame-charts\">\n" + frame_chart(chart) +
         "</div>\n";
}

std::vector<ChartPoint> score_points(const SummaryRow& row, const std::string& metric,
                                     const std::string& against) {
  std::vector<ChartPoint> points;
  const ScoreSummary* score = row.find_score(metric, against);
  if (score == nullptr) return points;
  for (const FrameScore& frame : score->frames) {
    points.push_back({static_cast<double>(frame.frame), frame.value});
  }
  return points;
}

std::vector<ChartLine> score_lines(const ReportData& data, const SceneView& scene,
                                   const std::string& metric, const std::string& against) {
  return lines_of(data, scene,
                  [&](const SummaryRow& row) { return score_points(row, metric, against); });
}

bool are_same(const std::vector<ChartLine>& a, const std::vector<ChartLine>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.color == y.color &&
           std::equal(x.points.begin(), x.points.end(), y.points.begin(), y.points.end(),
                      [](const auto& p, const auto& q) { return p.x == q.x && p.y == q.y; });
  });
}

FrameChart score_chart(const std::string& metric, const std::string& against,
                       std::vector<ChartLine> lines) {
  const metrics::MetricDescription* info = metric_info_of(metric);
  FrameChart chart;
  chart.title = fmt::format("{} ({})", metric, against);
  if (info != nullptr) chart.unit = info->unit;
  chart.starts_at_zero = info == nullptr || info->better == metrics::Better::lower;
  chart.lines = std::move(lines);
  chart.format = [](double value) { return base::format_significant(value, 3); };
  return chart;
}

std::vector<FrameChart> score_charts(const ReportData& data, const SceneView& scene) {
  std::vector<FrameChart> charts;
  for (const std::string& metric : data.summary.metrics) {
    std::vector<ChartLine> own = score_lines(data, scene, metric, "own");
    std::vector<ChartLine> full = score_lines(data, scene, metric, "full");
    if (are_same(own, full)) {
      charts.push_back(score_chart(metric, "own = full", std::move(full)));
      continue;
    }
    charts.push_back(score_chart(metric, "own", std::move(own)));
    charts.push_back(score_chart(metric, "full", std::move(full)));
  }
  return charts;
}

/// The same frames below each other in all charts, though some metrics have no score of the first.
void align(std::vector<FrameChart>& charts) {
  std::optional<std::pair<double, double>> range;
  for (const FrameChart& chart : charts) {
    for (const ChartLine& line : chart.lines) {
      if (!range) range = {line.points.front().x, line.points.back().x};
      range->first = std::min(range->first, line.points.front().x);
      range->second = std::max(range->second, line.points.back().x);
    }
  }
  for (FrameChart& chart : charts) chart.x_range = range;
}

/// Every method that has a line in some chart.
std::vector<ChartLine> legend_lines(const std::vector<FrameChart>& charts) {
  std::map<std::size_t, ChartLine> lines;
  for (const FrameChart& chart : charts) {
    for (const ChartLine& line : chart.lines) lines.emplace(line.color, line);
  }
  std::vector<ChartLine> all;
  for (auto& [color, line] : lines) all.push_back(std::move(line));
  return all;
}

/// Whether a metric's text, such as "flip,ppd=40", sets a parameter.
bool is_given(const std::string& metric, const std::string& parameter) {
  for (std::size_t comma = metric.find(','); comma != std::string::npos;) {
    const std::size_t equals = metric.find('=', comma);
    if (equals == std::string::npos) return false;
    if (base::is_same_name(metric.substr(comma + 1, equals - comma - 1), parameter)) return true;
    comma = metric.find(',', equals);
  }
  return false;
}

/// "start_exposure=-1.2,stop_exposure=3": parameters of a score that are neither the metric's
/// defaults nor given in the suite.
std::string found_settings(const MetricRecord& record) {
  const metrics::MetricDescription* info = metric_info_of(record.metric);
  if (info == nullptr) return "";
  ParameterValues found;
  for (const auto& [name, value] : record.parameters) {
    const bool is_other = std::any_of(
        info->parameters.begin(), info->parameters.end(),
        [&](const auto& spec) { return spec.name == name && spec.default_value != value; });
    if (is_other && !is_given(record.metric, name)) found.emplace_back(name, value);
  }
  return base::Parameters(found).to_text();
}

/// "full", or what a method claims: "own, one_bounce indirect".
std::string reference_text(const MetricRecord& record, const RenderRecord& render) {
  const std::string part = render.part == "all" ? "" : " " + render.part;
  const bool is_full = record.against == "full" || render.transport + part == "full";
  return is_full ? "full" : "own, " + render.transport + part;
}

/// "flip (full): start_exposure=-1.2,stop_exposure=3": what the frames of the scene share; each
/// text once.
std::vector<std::string> shared_settings(const ReportData& data, const SceneView& scene) {
  std::map<std::string, const RenderRecord*> cells;
  for (const SummaryRow* row : scene.rows) {
    for (const std::size_t index : row->records) {
      cells.emplace(data.run.cells[index].cell, &data.run.cells[index].render);
    }
  }
  std::vector<std::string> texts;
  for (const MetricRecord& record : data.run.metrics) {
    const auto cell = cells.find(record.cell);
    const std::string settings = found_settings(record);
    if (cell == cells.end() || settings.empty()) continue;
    const std::string text =
        fmt::format("{} ({}): {}", record.metric, reference_text(record, *cell->second), settings);
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
  }
  return texts;
}

std::string settings_note(const ReportData& data, const SceneView& scene) {
  std::string items;
  for (const std::string& text : shared_settings(data, scene)) {
    items += (items.empty() ? "" : "; ") + text;
  }
  if (items.empty()) return "";
  return "<p class=\"note\">The same for all frames of the sequence, found from its references: " +
         escape(items) + ".</p>\n";
}

std::string score_part(const ReportData& data, const SceneView& scene) {
  std::vector<FrameChart> charts = score_charts(data, scene);
  align(charts);
  std::string html;
  for (const FrameChart& chart : charts) html += frame_chart(chart);
  if (html.empty()) return "";
  return "<h3>Score per frame</h3>\n<p class=\"note\">Mean over seeds. own: against the transport "
         "the method claims; full: against all light.</p>\n" +
         settings_note(data, scene) + line_legend(legend_lines(charts)) +
         "<div class=\"frame-charts\">\n" + html + "</div>\n";
}

}  // namespace

std::string sequence_part(const ReportData& data, const SceneView& scene) {
  return time_chart(data, scene) + score_part(data, scene);
}

}  // namespace results::html_report
