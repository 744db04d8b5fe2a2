#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/convergence.h"
#include "results/html_report/frame_chart.h"
#include "results/html_report/html_text.h"
#include "results/html_report/sections.h"

namespace results::html_report {

namespace {

/// Scores at one checkpoint over the seeds.
struct SeedsAtPoint {
  std::vector<double> log_times;
  std::vector<double> scores;
};

std::vector<SeedsAtPoint> points_over_seeds(const std::vector<ConvergenceCurve>& curves) {
  std::vector<SeedsAtPoint> points;
  for (const ConvergenceCurve& curve : curves) {
    points.resize(std::max(points.size(), curve.points.size()));
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      points[i].log_times.push_back(std::log(curve.points[i].time_s));
      points[i].scores.push_back(curve.points[i].error);
    }
  }
  return points;
}

/// A score as the chart draws it: errors by their decimal logarithm.
double drawn(double score, bool is_log) { return is_log ? std::log10(score) : score; }

ChartPoint chart_point(const SeedsAtPoint& seeds, bool is_log) {
  const Estimate score = mean_with_interval(seeds.scores);
  ChartPoint point;
  point.x = std::exp(mean_with_interval(seeds.log_times).value);
  point.y = drawn(score.value, is_log);
  const bool has_both_ends = !is_log || score.low > 0.0;
  if (has_both_ends) point.spread = 0.5 * (drawn(score.high, is_log) - drawn(score.low, is_log));
  return point;
}

FrameChart chart_of(const ReportData& data, const RunValues& values, const SceneView& scene,
                    const Quantity& score) {
  const metrics::MetricDescription* info = metric_info_of(score.name);
  const bool is_log = info == nullptr || info->better == metrics::Better::lower;
  FrameChart chart;
  chart.title = fmt::format("{} ({})", score.name, score.against);
  chart.unit = score.unit;
  chart.x_title = "total time, s";
  chart.is_log_x = true;
  chart.starts_at_zero = false;
  chart.format = [is_log](double y) {
    return base::format_significant(is_log ? std::pow(10.0, y) : y, 2);
  };
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    const auto index = static_cast<std::size_t>(scene.rows[i] - data.summary.rows.data());
    ChartLine line{row_label(data, *scene.rows[i]), i, {}, false};
    for (const SeedsAtPoint& seeds : points_over_seeds(convergence_curves(values, index, score))) {
      line.points.push_back(chart_point(seeds, is_log));
    }
    if (line.points.size() > 1) chart.lines.push_back(std::move(line));
  }
  return chart;
}

}  // namespace

std::string convergence_part(const ReportData& data, const SceneView& scene) {
  if (data.run.checkpoint_scores.empty()) return "";
  const RunValues values(data.run);
  std::vector<ChartLine> legend;
  std::string html;
  for (const std::string& metric : data.summary.metrics) {
    for (const char* against : {"own", "full"}) {
      if (is_sequence_metric(metric)) continue;
      const Quantity score = values.find_quantity(fmt::format("score.{}@{}", metric, against), {});
      const FrameChart chart = chart_of(data, values, scene, score);
      if (chart.lines.empty()) continue;
      html += frame_chart(chart);
      if (chart.lines.size() > legend.size()) legend = chart.lines;
    }
  }
  if (html.empty()) return "";
  return "<h3>Convergence</h3>\n<p class=\"note\">Scores of the checkpoints of one render per seed "
         "over its time; both axes logarithmic where a score falls to 0. Bars: 95 % interval over "
         "seeds.</p>\n" +
         line_legend(legend) + "<div class=\"frame-charts\">\n" + html + "</div>\n";
}

}  // namespace results::html_report
