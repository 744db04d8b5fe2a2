#include "results/run_values.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "perception/base/quantile.h"
#include "results/record_fields.h"
#include "results/record_values.h"

namespace results {
namespace {

using nlohmann::ordered_json;

/// Fields that say something of a sequence's first frame only.
bool is_of_first_frame(std::string_view name) {
  return name == "prepare_s" || name == "new_view_s" || name == "start_up_s";
}

void append_values(const ordered_json& entry, const char* key, ParameterValues& values) {
  const auto map = entry.find(key);
  if (map == entry.end() || !map->is_object()) return;
  for (const auto& [name, json] : map->items()) {
    if (auto value = parameter_from_json(json)) values.emplace_back(name, std::move(*value));
  }
}

/// Entries of a list of run.json by their id.
class EntriesById {
 public:
  EntriesById(const ordered_json& info, const char* list) {
    const auto entries = info.find(list);
    if (entries == info.end() || !entries->is_array()) return;
    for (const ordered_json& entry : *entries) {
      if (entry.is_object()) entry_of_.try_emplace(entry.value("id", ""), &entry);
    }
  }
  /// Null if there is none.
  const ordered_json* find(const std::string& id) const {
    const auto found = entry_of_.find(id);
    return found == entry_of_.end() ? nullptr : found->second;
  }

 private:
  std::unordered_map<std::string, const ordered_json*> entry_of_;
};

/// "val[vals=30]" -> "val".
std::string base_of(const std::string& id) { return id.substr(0, id.find('[')); }

RowFacts facts_of(const EntriesById& scenes, const EntriesById& methods, const SummaryRow& row) {
  RowFacts facts;
  facts.scene = row.scene;
  facts.base_scene = base_of(row.scene);
  facts.method = row.method;
  facts.base_method = base_of(row.method);
  facts.budget = row.budget;
  if (const ordered_json* scene = scenes.find(row.scene)) {
    append_values(*scene, "sweep", facts.sweep);
    if (scene->contains("faces")) {
      facts.settings.emplace_back("faces", scene->at("faces").get<std::int64_t>());
    }
  }
  if (const ordered_json* method = methods.find(row.method)) {
    append_values(*method, "sweep", facts.sweep);
    append_values(*method, "parameters", facts.settings);
    for (const char* key : {"renderer", "preset"}) {
      facts.settings.emplace_back(key, method->value(key, ""));
    }
  }
  facts.settings.emplace_back("method", row.method);
  facts.settings.emplace_back("scene", row.scene);
  facts.settings.emplace_back("budget", row.budget);
  return facts;
}

void set_value(ParameterValues& values, const std::string& name, base::ParameterValue value) {
  for (auto& [known, held] : values) {
    if (known == name) held = value;
  }
}

/// What the row's cells were rendered with: a budget has its say about samples, and what was
/// searched for about the setting that was found.
void set_measured(const Run& run, const SummaryRow& row, RowFacts& facts) {
  for (const std::size_t index : row.records) {
    const RenderRecord& render = run.cells[index].render;
    if (!is_success(render.status)) continue;
    for (const auto& [name, value] : render.parameters) set_value(facts.settings, name, value);
    if (render.samples) set_value(facts.settings, "samples", *render.samples);
    return;
  }
}

/// Whether a stage is a readback that lies in the stage `path`, and in no other readback there:
/// "gather/readback" in "gather".
bool is_readback_within(std::string_view stage, std::string_view path) {
  constexpr std::string_view kReadback = "readback";
  if (stage.size() <= path.size() || stage.substr(0, path.size()) != path) return false;
  if (stage[path.size()] != '/') return false;
  const std::string_view inner = stage.substr(path.size() + 1);
  const std::size_t first = ("/" + std::string(inner)).find("/readback");
  return first != std::string::npos && first + kReadback.size() == inner.size();
}

/// All phases of a stage together but new_view; as in total_s, without the readback within it.
std::optional<double> stage_s(const RenderRecord& render, const std::string& path) {
  std::optional<double> sum_s;
  double readback_s = 0.0;
  for (const renderers::StageRecord& stage : render.stages) {
    if (stage.phase == renderers::Phase::new_view) continue;
    if (stage.path == path) sum_s = sum_s.value_or(0.0) + stage.wall_s;
    if (is_readback_within(stage.path, path)) readback_s += stage.wall_s;
  }
  return sum_s ? std::optional(*sum_s - readback_s) : std::nullopt;
}

std::vector<double> counter_values(const RenderRecord& render, const std::string& name) {
  for (const auto& [known, value] : render.counters) {
    if (known != name) continue;
    if (const auto* number = std::get_if<double>(&value)) return {*number};
    return std::get<std::vector<double>>(value);
  }
  return {};
}

std::vector<double> values_of(const RenderRecord& render, const Quantity& quantity) {
  std::optional<double> value;
  if (quantity.kind == Quantity::Kind::time)
    value = find_record_field(quantity.name)->value(render);
  if (quantity.kind == Quantity::Kind::stage) value = stage_s(render, quantity.name);
  if (quantity.kind == Quantity::Kind::counter) return counter_values(render, quantity.name);
  return value ? std::vector<double>{*value} : std::vector<double>{};
}

}  // namespace

RunValues::RunValues(const Run& run) : run_(run), summary_(summarize(run)) {
  std::map<std::string, std::size_t> row_of_cell;
  const EntriesById scenes(*run.info, "scenes");
  const EntriesById methods(*run.info, "methods");
  for (std::size_t i = 0; i < summary_.rows.size(); ++i) {
    rows_.push_back(facts_of(scenes, methods, summary_.rows[i]));
    set_measured(run, summary_.rows[i], rows_.back());
    for (const std::size_t record : summary_.rows[i].records) {
      row_of_cell.emplace(run.cells[record].cell, i);
    }
  }
  collect_names();
  scores_of_row_.resize(rows_.size());
  for (std::size_t i = 0; i < run.metrics.size(); ++i) {
    const auto row = row_of_cell.find(run.metrics[i].cell);
    if (row != row_of_cell.end()) scores_of_row_[row->second].push_back(i);
  }
}

std::vector<Sample> RunValues::samples(std::size_t row, const Quantity& quantity) const {
  std::vector<Sample> samples;
  const auto add = [&](double value, const Sample& of) {
    if (!std::isfinite(value)) return;
    samples.push_back(of);
    samples.back().value = value;
  };
  if (quantity.kind == Quantity::Kind::parameter) {
    const base::ParameterValue* value = rows_[row].find(quantity.name);
    const std::optional<double> number = value == nullptr ? std::nullopt : number_of(*value);
    if (number) add(*number, {});
    return samples;
  }
  if (quantity.kind == Quantity::Kind::score) {
    std::map<std::string, std::uint64_t> seed_of_cell;
    for (const std::size_t record : summary_.rows[row].records) {
      seed_of_cell[run_.cells[record].cell] = run_.cells[record].render.seed;
    }
    for (const std::size_t index : scores_of_row_[row]) {
      const MetricRecord& record = run_.metrics[index];
      if (record.metric != quantity.name || record.against != quantity.against) continue;
      const std::optional<double> value = score_value(record, quantity.detail);
      if (value) add(*value, {0.0, seed_of_cell[record.cell], 0, record.frame});
    }
  } else {
    const bool is_following = summary_.rows[row].is_sequence && !quantity.is_first_frame &&
                              !is_of_first_frame(quantity.name);
    for (const std::size_t index : summary_.rows[row].records) {
      const CellRecord& record = run_.cells[index];
      const RenderRecord& render = record.render;
      if (!is_success(render.status)) continue;
      if (summary_.rows[row].is_sequence && is_following != render.next_frame_s.has_value())
        continue;
      for (const double value : values_of(render, quantity)) {
        add(value, {0.0, render.seed, record.repetition, render.frame});
      }
    }
  }
  std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return std::tie(a.seed, a.repetition, a.frame) < std::tie(b.seed, b.repetition, b.frame);
  });
  return samples;
}

std::optional<Estimate> RunValues::estimate(std::size_t row, const Quantity& quantity) const {
  const std::vector<Sample> all = samples(row, quantity);
  if (all.empty()) return std::nullopt;
  const bool is_score = quantity.kind == Quantity::Kind::score;
  const bool is_mean = is_score && is_sequence_metric(quantity.name);
  const std::vector<double> values = values_over_frames(all, is_mean);
  return is_score ? mean_with_interval(values) : median_with_interval(values);
}

std::vector<double> values_over_frames(const std::vector<Sample>& samples, bool is_mean) {
  std::map<std::pair<std::uint64_t, int>, std::vector<double>> groups;
  for (const Sample& sample : samples) {
    groups[{sample.seed, sample.repetition}].push_back(sample.value);
  }
  std::vector<double> values;
  for (const auto& [key, group] : groups) {
    const double sum = std::accumulate(group.begin(), group.end(), 0.0);
    values.push_back(is_mean ? sum / static_cast<double>(group.size()) : base::median(group));
  }
  return values;
}

}  // namespace results
