#include "results/run_summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include <nlohmann/json.hpp>

namespace results {

using nlohmann::ordered_json;

namespace {

/// Names in the order they are first met.
class NameOrder {
 public:
  void add(const std::string& name) {
    if (position_of_.try_emplace(name, names_.size()).second) names_.push_back(name);
  }
  std::size_t position(const std::string& name) const { return position_of_.at(name); }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> position_of_;
};

/// Names in the order of run.json: a list of texts, or of objects with "id".
NameOrder order_from(const ordered_json& info, const char* key) {
  NameOrder names;
  const auto list = info.find(key);
  if (list == info.end() || !list->is_array()) return names;
  for (const ordered_json& entry : *list) {
    const ordered_json* name = &entry;
    if (entry.is_object() && entry.contains("id")) name = &entry.at("id");
    if (name->is_string()) names.add(name->get<std::string>());
  }
  return names;
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

/// Whether run.json lists several frames of the scene.
bool is_planned_sequence(const ordered_json& info, const std::string& scene) {
  const auto scenes = info.find("scenes");
  if (scenes == info.end() || !scenes->is_array()) return false;
  return std::any_of(scenes->begin(), scenes->end(), [&](const ordered_json& entry) {
    return entry.is_object() && entry.value("id", "") == scene && entry.contains("frames") &&
           entry.at("frames").size() > 1;
  });
}

bool is_listed(const ordered_json& entry, const char* key, const std::string& id) {
  const auto list = entry.find(key);
  if (list == entry.end() || list->empty()) return true;
  return std::any_of(list->begin(), list->end(), [&](const ordered_json& one) {
    return one == id || one == id.substr(0, id.find('['));
  });
}

/// Whether run.json says that the metric scores the row against this; true if it says nothing.
bool is_wanted(const ordered_json& info, const ScoreSummary& score, const SummaryRow& row) {
  const auto list = info.find("metrics");
  if (list == info.end() || !list->is_array()) return true;
  for (const ordered_json& entry : *list) {
    if (!entry.is_object() || entry.value("id", "") != score.metric) continue;
    return is_listed(entry, "against", score.against) && is_listed(entry, "scenes", row.scene) &&
           is_listed(entry, "methods", row.method);
  }
  return true;
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
      count_statuses(row);
      summarize_time(row);
      choose_shown(row);
      count_frames(row);
      summarize_scores(row);
    }
    return std::move(summary_);
  }

 private:
  void collect_names() {
    scenes_ = order_from(*run_.info, "scenes");
    methods_ = order_from(*run_.info, "methods");
    budgets_ = order_from(*run_.info, "budgets");
    NameOrder metrics = order_from(*run_.info, "metrics");
    for (const MetricRecord& record : run_.metrics) metrics.add(record.metric);
    summary_.metrics = metrics.names();
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
      scenes_.add(scene);
      methods_.add(method);
      budgets_.add(budget);
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
    summary_.scenes = scenes_.names();
    summary_.methods = methods_.names();
    summary_.budgets = budgets_.names();
    const auto key = [&](const SummaryRow& row) {
      return std::tuple(scenes_.position(row.scene), methods_.position(row.method),
                        budgets_.position(row.budget));
    };
    std::stable_sort(summary_.rows.begin(), summary_.rows.end(),
                     [&](const SummaryRow& a, const SummaryRow& b) { return key(a) < key(b); });
  }

  /// A sequence's repetition has the first status of its frames that is no success.
  void count_statuses(SummaryRow& row) {
    std::map<std::pair<std::string, int>, Status> repetitions;
    for (const std::size_t index : row.records) {
      const CellRecord& record = run_.cells[index];
      const auto [entry, is_new] =
          repetitions.try_emplace({record.cell, record.repetition}, record.render.status);
      if (!is_new && is_success(entry->second)) entry->second = record.render.status;
    }
    std::map<Status, std::size_t> counts;
    for (const auto& [repetition, status] : repetitions) ++counts[status];
    row.repetitions = repetitions.size();
    row.statuses.assign(counts.begin(), counts.end());
  }

  void summarize_time(SummaryRow& row) {
    std::vector<std::pair<double, std::size_t>> times;
    std::vector<double> new_views;
    for (const std::size_t index : row.records) {
      const RenderRecord& render = run_.cells[index].render;
      const bool is_first_frame = !render.next_frame_s && std::isfinite(render.total_s);
      if (!is_success(render.status) || !is_first_frame) continue;
      times.emplace_back(render.total_s, index);
      if (render.new_view_s && std::isfinite(*render.new_view_s)) {
        new_views.push_back(*render.new_view_s);
      }
    }
    row.next_frames = frame_times(run_.cells, row.records);
    if (!new_views.empty()) row.new_view_s = median_with_interval(new_views);
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

  void count_frames(SummaryRow& row) {
    std::set<int> frames;
    for (const std::size_t index : row.records) {
      const RenderRecord& render = run_.cells[index].render;
      if (!render.image.empty()) frames.insert(render.frame);
    }
    row.frames = frames.size();
    row.is_sequence = frames.size() > 1 || is_planned_sequence(*run_.info, row.scene);
  }

  void summarize_scores(SummaryRow& row) {
    std::set<std::string> cells;
    for (const std::size_t index : row.records) cells.insert(run_.cells[index].cell);
    for (const std::string& metric : summary_.metrics) {
      for (const char* against : {"own", "full"}) {
        row.scores.push_back(results::summarize_scores(scores_of_cell_, cells, metric, against));
        row.scores.back().is_wanted = is_wanted(*run_.info, row.scores.back(), row);
      }
    }
  }

  const Run& run_;
  NameOrder scenes_;
  NameOrder methods_;
  NameOrder budgets_;
  RunSummary summary_;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> row_index_;
  std::map<std::string, std::set<Status>> cells_;
  ScoresOfCell scores_of_cell_;
};

}  // namespace

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

}  // namespace results
