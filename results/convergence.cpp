#include "results/convergence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "results/record_fields.h"

namespace results {
namespace {

/// y at x on the line from (x0, y0) to (x1, y1) in log x, and in log y where both are above 0.
double interpolated(double x, double x0, double y0, double x1, double y1) {
  const double share = x1 == x0 ? 0.0 : std::log(x / x0) / std::log(x1 / x0);
  if (y0 <= 0.0 || y1 <= 0.0) return y0 + share * (y1 - y0);
  return std::exp(std::log(y0) + share * (std::log(y1) - std::log(y0)));
}

/// x at y on the same line.
double inverted(double y, double x0, double y0, double x1, double y1) {
  if (y0 == y1) return x0;
  const bool is_log = y0 > 0.0 && y1 > 0.0 && y > 0.0;
  const double share = is_log ? std::log(y / y0) / std::log(y1 / y0) : (y - y0) / (y1 - y0);
  return std::exp(std::log(x0) + share * std::log(x1 / x0));
}

std::optional<double> score_at(const ConvergenceCurve& curve, double time_s) {
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    const CurvePoint& a = curve.points[i - 1];
    const CurvePoint& b = curve.points[i];
    if (time_s < a.time_s || time_s > b.time_s) continue;
    return interpolated(time_s, a.time_s, a.error, b.time_s, b.error);
  }
  return std::nullopt;
}

/// Where the curve first comes from the worse side; its first point must be worse.
std::optional<double> time_at(const ConvergenceCurve& curve, double score, bool is_falling) {
  const auto is_reached = [&](const CurvePoint& point) {
    return is_falling ? point.error <= score : point.error >= score;
  };
  if (curve.points.empty() || is_reached(curve.points.front())) return std::nullopt;
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    const CurvePoint& a = curve.points[i - 1];
    const CurvePoint& b = curve.points[i];
    if (is_reached(b)) return inverted(score, a.time_s, a.error, b.time_s, b.error);
  }
  return std::nullopt;
}

void sort_by_time(ConvergenceCurve& curve) {
  std::stable_sort(curve.points.begin(), curve.points.end(),
                   [](const CurvePoint& a, const CurvePoint& b) { return a.time_s < b.time_s; });
}

/// The row's cells by name, with the seed and the first successful still frame of each.
std::map<std::string, const RenderRecord*> finished_cells(const RunValues& values,
                                                          std::size_t row) {
  std::map<std::string, const RenderRecord*> cells;
  for (const std::size_t index : values.summary().rows[row].records) {
    const CellRecord& record = values.run().cells[index];
    const bool is_usable = is_success(record.render.status) && !record.render.next_frame_s;
    if (is_usable) cells.try_emplace(record.cell, &record.render);
  }
  return cells;
}

}  // namespace

std::vector<ConvergenceCurve> convergence_curves(const RunValues& values, std::size_t row,
                                                 const Quantity& score) {
  const std::map<std::string, const RenderRecord*> cells = finished_cells(values, row);
  std::map<std::string, ConvergenceCurve> curves;
  for (const CheckpointScore& point : values.run().checkpoint_scores) {
    const MetricRecord& record = point.score;
    if (record.metric != score.name || record.against != score.against) continue;
    const auto cell = cells.find(record.cell);
    const std::optional<double> value = score_value(record, score.detail);
    if (cell == cells.end() || !value || !std::isfinite(*value)) continue;
    ConvergenceCurve& curve = curves[record.cell];
    curve.seed = cell->second->seed;
    curve.points.push_back({static_cast<double>(point.samples), point.elapsed_s, *value});
  }
  for (const MetricRecord& record : values.run().metrics) {
    const auto curve = curves.find(record.cell);
    const bool is_score = record.metric == score.name && record.against == score.against;
    if (curve == curves.end() || !is_score) continue;
    const std::optional<double> value = score_value(record, score.detail);
    const RenderRecord& render = *cells.at(record.cell);
    if (!value || !std::isfinite(*value)) continue;
    curve->second.points.push_back(
        {static_cast<double>(render.samples.value_or(0)), timed_s(render), *value});
  }
  std::vector<ConvergenceCurve> sorted;
  for (auto& [cell, curve] : curves) {
    sort_by_time(curve);
    sorted.push_back(std::move(curve));
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const auto& a, const auto& b) { return a.seed < b.seed; });
  return sorted;
}

std::vector<double> scores_at_time(std::span<const ConvergenceCurve> curves, double time_s) {
  std::vector<double> scores;
  for (const ConvergenceCurve& curve : curves) {
    if (const auto score = score_at(curve, time_s)) scores.push_back(*score);
  }
  return scores;
}

std::vector<double> times_to_score(std::span<const ConvergenceCurve> curves, double score,
                                   bool is_falling) {
  std::vector<double> times_s;
  for (const ConvergenceCurve& curve : curves) {
    if (const auto time_s = time_at(curve, score, is_falling)) times_s.push_back(*time_s);
  }
  return times_s;
}

std::optional<Estimate> score_at_time(std::span<const ConvergenceCurve> curves, double time_s) {
  const std::vector<double> scores = scores_at_time(curves, time_s);
  if (scores.empty()) return std::nullopt;
  return mean_with_interval(scores);
}

std::optional<Estimate> time_to_score(std::span<const ConvergenceCurve> curves, double score,
                                      bool is_falling) {
  std::vector<double> logarithms;
  for (const double time_s : times_to_score(curves, score, is_falling)) {
    logarithms.push_back(std::log(time_s));
  }
  if (logarithms.empty()) return std::nullopt;
  Estimate estimate = mean_with_interval(logarithms);
  for (double* part : {&estimate.value, &estimate.low, &estimate.high}) *part = std::exp(*part);
  return estimate;
}

}  // namespace results
