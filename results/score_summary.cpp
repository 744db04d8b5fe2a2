#include "results/score_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "metrics/metric_list.h"
#include "perception/base/quantile.h"

namespace results {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A score is marked if more than this part of its error is noise of the reference: then its second
/// digit says nothing of the method (ours).
constexpr double kUnmarkedNoiseShare = 0.1;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The part of the error that is noise of the reference; nothing if the score or its floor is not
/// known.
std::optional<double> noise_share(const ScoreSummary& summary) {
  if (!summary.score || !summary.noise_floor) return std::nullopt;
  const double score = summary.score->value;
  const double floor = *summary.noise_floor;
  const metrics::MetricDescription* info = metric_info_of(summary.metric);
  // No distance is known; most metrics are errors.
  if (info == nullptr) return score <= floor ? 1.0 : 0.0;
  // Without a finite best score the scale is one of decibels: -10 log10(error).
  if (std::isinf(info->identical_value)) return std::pow(10.0, (score - floor) / 10.0);
  const double error = std::abs(score - info->identical_value);
  const double noise = std::abs(floor - info->identical_value);
  if (noise == 0.0) return 0.0;
  return error > 0.0 ? noise / error : kInfinity;
}

double score_of(const MetricRecord& record) {
  return record.is_infinite ? kInfinity : record.value.value_or(std::nan(""));
}

/// The score of a seed: the median over its frames, of a sequence metric their mean; infinite only
/// if every frame is; NaN if one is no number, or if they are finite and infinite.
double score_of_frames(const std::vector<double>& frames, bool is_of_sequence) {
  const auto is_finite = [](double frame) { return std::isfinite(frame); };
  if (std::all_of(frames.begin(), frames.end(), is_finite)) {
    return is_of_sequence ? mean(frames) : base::median(frames);
  }
  const bool is_perfect =
      std::all_of(frames.begin(), frames.end(), [](double frame) { return frame == kInfinity; });
  return is_perfect ? kInfinity : std::nan("");
}

/// Mean over seeds, frame by frame; nothing for a row of one frame.
std::vector<FrameScore> frame_scores(const std::map<int, std::vector<double>>& seeds_of_frame) {
  std::vector<FrameScore> frames;
  if (seeds_of_frame.size() < 2) return frames;
  for (const auto& [frame, seeds] : seeds_of_frame) frames.push_back({frame, mean(seeds)});
  return frames;
}

std::optional<FrameScore> worst_frame(const ScoreSummary& summary) {
  const metrics::MetricDescription* info = metric_info_of(summary.metric);
  const double sign = info == nullptr || info->better == metrics::Better::lower ? 1.0 : -1.0;
  std::optional<FrameScore> worst;
  for (const FrameScore& frame : summary.frames) {
    if (!std::isfinite(frame.value)) continue;
    if (!worst || sign * frame.value > sign * worst->value) worst = frame;
  }
  return worst;
}

}  // namespace

std::optional<double> ScoreSummary::value() const {
  if (score) return score->value;
  return perfect > 0 ? std::optional(kInfinity) : std::nullopt;
}

std::size_t ScoreSummary::seeds() const { return score ? score->count : perfect; }

ScoreSummary summarize_scores(const ScoresOfCell& scores, const std::set<std::string>& cells,
                              const std::string& metric, const std::string& against) {
  ScoreSummary summary;
  summary.metric = metric;
  summary.against = against;
  std::vector<double> values;
  std::vector<double> floors;
  std::map<int, std::vector<double>> seeds_of_frame;
  for (const std::string& cell : cells) {
    const auto found = scores.find(cell);
    if (found == scores.end()) continue;
    std::vector<double> frames;
    for (const MetricRecord* record : found->second) {
      if (record->metric != metric || record->against != against) continue;
      frames.push_back(score_of(*record));
      seeds_of_frame[record->frame].push_back(frames.back());
      if (record->noise_floor) floors.push_back(*record->noise_floor);
    }
    if (frames.empty()) continue;
    const double value = score_of_frames(frames, is_sequence_metric(metric));
    if (std::isfinite(value)) {
      values.push_back(value);
    } else {
      ++(std::isinf(value) ? summary.perfect : summary.non_finite);
    }
  }
  if (!values.empty()) summary.score = mean_with_interval(values);
  if (!floors.empty()) summary.noise_floor = mean(floors);
  summary.noise_share = noise_share(summary);
  summary.has_reference_noise = summary.noise_share.value_or(0.0) > kUnmarkedNoiseShare;
  summary.frames = frame_scores(seeds_of_frame);
  summary.worst = worst_frame(summary);
  return summary;
}

const metrics::MetricDescription* metric_info_of(const std::string& metric) {
  const std::string id = metric_id_of(metric);
  const std::string_view choice =
      std::string_view(metric).substr(id.empty() ? std::size_t{0} : id.size() + 1);
  return metrics::find_description(choice.substr(0, choice.find(',')));
}

std::string metric_id_of(const std::string& metric) {
  const std::size_t end = metric.find_first_of(":,");
  const bool has_id = end != std::string::npos && metric[end] == ':';
  return has_id ? metric.substr(0, end) : std::string();
}

bool is_sequence_metric(const std::string& metric) {
  const metrics::MetricDescription* info = metric_info_of(metric);
  return info != nullptr && info->scope == metrics::MetricScope::sequence;
}

}  // namespace results
