#include "results/run_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include <nlohmann/json.hpp>

#include "metrics/metric_list.h"
#include "perception/base/names.h"

namespace results {

using nlohmann::ordered_json;

namespace {

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Names in the order of run.json: a list of texts, or of objects with "id".
std::vector<std::string> order_from(const ordered_json& info, const char* key) {
  std::vector<std::string> names;
  const auto list = info.find(key);
  if (list == info.end() || !list->is_array()) return names;
  for (const ordered_json& entry : *list) {
    const ordered_json* name = &entry;
    if (entry.is_object() && entry.contains("id")) name = &entry.at("id");
    if (name->is_string()) add_once(names, name->get<std::string>());
  }
  return names;
}

std::size_t position(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

struct PlannedCell {
  std::string cell, scene, method, budget;
};

std::vector<PlannedCell> planned_cells(const ordered_json& info) {
  std::vector<PlannedCell> cells;
  const auto list = info.find("planned_cells");
  if (list == info.end() || !list->is_array()) return cells;
  for (const ordered_json& entry : *list) {
    if (!entry.is_object()) continue;
    cells.push_back({entry.value("cell", ""), entry.value("scene", ""), entry.value("method", ""),
                     entry.value("budget", "")});
  }
  return cells;
}

bool is_failure(Status status) {
  return !is_success(status) && status != Status::unsupported && status != Status::skipped;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A score is marked if more than this part of its error is noise of the reference: then its second
/// digit says nothing of the method (ours).
constexpr double kUnmarkedNoiseShare = 0.1;

/// Whether the noise floor is more than the unmarked part of the error, error being the distance
/// from the score of identical images.
bool has_reference_noise(const ScoreSummary& summary) {
  if (!summary.score || !summary.noise_floor) return false;
  const double score = summary.score->value;
  const double floor = *summary.noise_floor;
  const metrics::MetricInfo* info = metric_info_of(summary.metric);
  if (info == nullptr) return score <= floor;  // no distance is known; most metrics are errors
  // Without a finite best score the scale is one of decibels: -10 log10(error).
  if (std::isinf(info->identical_value)) {
    return floor - score < -10.0 * std::log10(kUnmarkedNoiseShare);
  }
  const double sign = info->better == metrics::Better::lower ? 1.0 : -1.0;
  return sign * (floor - info->identical_value) >
         kUnmarkedNoiseShare * sign * (score - info->identical_value);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The score of a seed: the mean over its frames, infinite only if every frame is; NaN if one is no
/// number, or if they are finite and infinite.
double score_of_frames(const std::vector<double>& frames) {
  const double value = mean(frames);
  if (!std::isinf(value)) return value;
  const bool is_perfect =
      std::all_of(frames.begin(), frames.end(), [](double frame) { return frame == kInfinity; });
  return is_perfect ? kInfinity : std::nan("");
}

/// Builds the rows of a run step by step.
class Summarizer {
 public:
  explicit Summarizer(const Run& run) : run_(run) {
    for (const MetricRecord& record : run.metrics) scores_of_cell_[record.cell].push_back(&record);
  }

  RunSummary summarize() {
    collect_names();
    collect_records();
    count_cells();
    sort_rows();
    for (SummaryRow& row : summary_.rows) {
      summarize_time(row);
      choose_shown(row);
      summarize_scores(row);
    }
    return std::move(summary_);
  }

 private:
  void collect_names() {
    summary_.scenes = order_from(*run_.info, "scenes");
    summary_.methods = order_from(*run_.info, "methods");
    summary_.budgets = order_from(*run_.info, "budgets");
    summary_.metrics = order_from(*run_.info, "metrics");
    for (const MetricRecord& record : run_.metrics) add_once(summary_.metrics, record.metric);
  }

  SummaryRow& row_of(const std::string& scene, const std::string& method,
                     const std::string& budget) {
    const auto [entry, is_new] =
        row_index_.try_emplace(std::tuple(scene, method, budget), summary_.rows.size());
    if (is_new) {
      SummaryRow row;
      row.scene = scene;
      row.method = method;
      row.budget = budget;
      summary_.rows.push_back(std::move(row));
      add_once(summary_.scenes, scene);
      add_once(summary_.methods, method);
      add_once(summary_.budgets, budget);
    }
    return summary_.rows[entry->second];
  }

  void collect_records() {
    std::map<std::size_t, std::set<std::string>> cells_of_row;
    for (std::size_t i = 0; i < run_.cells.size(); ++i) {
      const CellRecord& record = run_.cells[i];
      SummaryRow& row = row_of(record.scene, record.method, record.budget);
      row.records.push_back(i);
      cells_of_row[static_cast<std::size_t>(&row - summary_.rows.data())].insert(record.cell);
      cells_[record.cell].insert(record.render.status);
    }
    for (const auto& [row, cells] : cells_of_row) summary_.rows[row].seeds = cells.size();
    for (const PlannedCell& cell : planned_cells(*run_.info)) {
      if (cells_.contains(cell.cell)) continue;
      ++row_of(cell.scene, cell.method, cell.budget).missing_cells;
      ++summary_.missing_cells;
    }
  }

  void count_cells() {
    for (const auto& [cell, statuses] : cells_) {
      if (std::any_of(statuses.begin(), statuses.end(), is_failure)) {
        ++summary_.failed_cells;
      } else if (std::all_of(statuses.begin(), statuses.end(), is_success)) {
        ++summary_.ok_cells;
      } else {
        ++summary_.skipped_cells;
      }
    }
  }

  void sort_rows() {
    const auto key = [&](const SummaryRow& row) {
      return std::tuple(position(summary_.scenes, row.scene),
                        position(summary_.methods, row.method),
                        position(summary_.budgets, row.budget));
    };
    std::stable_sort(summary_.rows.begin(), summary_.rows.end(),
                     [&](const SummaryRow& a, const SummaryRow& b) { return key(a) < key(b); });
  }

  void summarize_time(SummaryRow& row) {
    std::map<Status, std::size_t> counts;
    std::vector<std::pair<double, std::size_t>> times;
    for (const std::size_t index : row.records) {
      const RenderRecord& render = run_.cells[index].render;
      ++counts[render.status];
      if (is_success(render.status) && std::isfinite(render.total_s)) {
        times.emplace_back(render.total_s, index);
      }
    }
    row.statuses.assign(counts.begin(), counts.end());
    if (times.empty()) return;
    std::vector<double> values;
    for (const auto& [total_s, index] : times) values.push_back(total_s);
    row.total_s = median_with_interval(values);
    std::sort(times.begin(), times.end());
    row.typical = times[(times.size() - 1) / 2].second;
  }

  void choose_shown(SummaryRow& row) {
    for (const std::size_t index : row.records) {
      const RenderRecord& render = run_.cells[index].render;
      if (render.image.empty()) continue;
      const bool is_first = !row.shown;
      if (is_first || render.seed < run_.cells[*row.shown].render.seed) row.shown = index;
    }
  }

  void summarize_scores(SummaryRow& row) {
    std::set<std::string> cells;
    for (const std::size_t index : row.records) cells.insert(run_.cells[index].cell);
    for (const std::string& metric : summary_.metrics) {
      for (const char* against : {"own", "full"}) {
        row.scores.push_back(score_of(cells, metric, against));
      }
    }
  }

  /// Mean over the frames of each cell, then over cells of finite score.
  ScoreSummary score_of(const std::set<std::string>& cells, const std::string& metric,
                        const std::string& against) const {
    ScoreSummary summary;
    summary.metric = metric;
    summary.against = against;
    std::vector<double> values;
    std::vector<double> floors;
    for (const std::string& cell : cells) {
      const auto scores = scores_of_cell_.find(cell);
      if (scores == scores_of_cell_.end()) continue;
      std::vector<double> frames;
      for (const MetricRecord* record : scores->second) {
        if (record->metric != metric || record->against != against) continue;
        frames.push_back(record->is_infinite ? kInfinity : record->value.value_or(std::nan("")));
        if (record->noise_floor) floors.push_back(*record->noise_floor);
      }
      if (frames.empty()) continue;
      const double value = score_of_frames(frames);
      if (std::isfinite(value)) {
        values.push_back(value);
      } else {
        ++(std::isinf(value) ? summary.perfect : summary.non_finite);
      }
    }
    if (!values.empty()) summary.score = mean_with_interval(values);
    if (!floors.empty()) summary.noise_floor = mean(floors);
    summary.has_reference_noise = has_reference_noise(summary);
    return summary;
  }

  const Run& run_;
  RunSummary summary_;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> row_index_;
  std::map<std::string, std::set<Status>> cells_;
  std::map<std::string, std::vector<const MetricRecord*>> scores_of_cell_;
};

}  // namespace

std::optional<double> ScoreSummary::value() const {
  if (score) return score->value;
  return perfect > 0 ? std::optional(kInfinity) : std::nullopt;
}

std::size_t ScoreSummary::seeds() const { return score ? score->count : perfect; }

bool SummaryRow::has_failure() const {
  return std::any_of(statuses.begin(), statuses.end(),
                     [](const auto& entry) { return is_failure(entry.first); });
}

const ScoreSummary* SummaryRow::find_score(const std::string& metric,
                                           const std::string& against) const {
  for (const ScoreSummary& score : scores) {
    if (score.metric == metric && score.against == against) return &score;
  }
  return nullptr;
}

RunSummary summarize(const Run& run) { return Summarizer(run).summarize(); }

const metrics::MetricInfo* metric_info_of(const std::string& metric) {
  const std::string name = metric.substr(0, metric.find(','));
  for (const metrics::MetricInfo& info : metrics::metric_list()) {
    if (base::is_same_name(info.name, name)) return &info;
  }
  return nullptr;
}

}  // namespace results
