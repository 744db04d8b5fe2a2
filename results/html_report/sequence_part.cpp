#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "metrics/metric_list.h"
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

std::string score_chart(const std::string& metric, const std::string& against,
                        std::vector<ChartLine> lines) {
  const metrics::MetricInfo* info = metric_info_of(metric);
  FrameChart chart;
  chart.title = fmt::format("{} ({})", metric, against);
  chart.starts_at_zero = info == nullptr || info->better == metrics::Better::lower;
  chart.lines = std::move(lines);
  chart.format = [](double value) { return base::format_significant(value, 3); };
  return frame_chart(chart);
}

std::string score_charts(const ReportData& data, const SceneView& scene) {
  std::string charts;
  for (const std::string& metric : data.summary.metrics) {
    std::vector<ChartLine> own = score_lines(data, scene, metric, "own");
    std::vector<ChartLine> full = score_lines(data, scene, metric, "full");
    if (are_same(own, full)) {
      charts += score_chart(metric, "own = full", std::move(full));
      continue;
    }
    charts += score_chart(metric, "own", std::move(own));
    charts += score_chart(metric, "full", std::move(full));
  }
  if (charts.empty()) return "";
  return "<h3>Score per frame</h3>\n<p class=\"note\">Mean over seeds. own: against the transport "
         "the method claims; full: against all light.</p>\n" +
         line_legend(lines_of(data, scene,
                              [&](const SummaryRow& row) {
                                return score_points(row, data.summary.metrics.front(), "full");
                              })) +
         "<div class=\"frame-charts\">\n" + charts + "</div>\n";
}

}  // namespace

std::string sequence_part(const ReportData& data, const SceneView& scene) {
  return time_chart(data, scene) + score_charts(data, scene);
}

}  // namespace results::html_report
