#include "results/comparison/row_pairs.h"

#include <algorithm>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "results/row_selector.h"

namespace results::comparison {

std::vector<RowPair> paired_rows(const RunSummary& before, const RunSummary& after) {
  using Key = std::tuple<std::string, std::string, std::string>;
  std::map<Key, std::size_t> left;
  for (std::size_t i = 0; i < before.rows.size(); ++i) {
    const SummaryRow& row = before.rows[i];
    left[{row.scene, row.method, row.budget}] = i;
  }
  std::vector<RowPair> pairs;
  for (std::size_t i = 0; i < after.rows.size(); ++i) {
    const SummaryRow& row = after.rows[i];
    RowPair pair{nullptr, &row, 0, i};
    const auto found = left.find({row.scene, row.method, row.budget});
    if (found != left.end()) {
      pair.before = &before.rows[found->second];
      pair.before_index = found->second;
      left.erase(found);
    }
    pairs.push_back(pair);
  }
  for (const auto& [key, index] : left) pairs.push_back({&before.rows[index], nullptr, index, 0});
  return pairs;
}

const CellRecord* first_record(const Run& run, const SummaryRow& row) {
  return row.records.empty() ? nullptr : &run.cells[row.records.front()];
}

std::string difference_of_pictures(const RenderRecord& before, const RenderRecord& after) {
  if (before.width_px != after.width_px || before.height_px != after.height_px) {
    return fmt::format("size was {}x{}, is {}x{}", before.width_px, before.height_px,
                       after.width_px, after.height_px);
  }
  if (before.scene_hash != after.scene_hash) return "the scene is another one";
  return "";
}

std::string difference_of_machines(const CellRecord& before, const CellRecord& after) {
  if (before.machine != after.machine) {
    return fmt::format("measured on {}, before on {}", after.machine, before.machine);
  }
  if (before.render.device != after.render.device) {
    return fmt::format("device was {}, is {}", before.render.device, after.render.device);
  }
  if (before.jobs != after.jobs) {
    return fmt::format("{} repetitions ran at once, before {}", after.jobs, before.jobs);
  }
  if (before.render.threads != after.render.threads) {
    return fmt::format("threads were {}, are {}", before.render.threads, after.render.threads);
  }
  return "";
}

const MetricRecord* first_score(const Run& run, const SummaryRow& row, const Quantity& score) {
  for (const MetricRecord& record : run.metrics) {
    if (record.metric != score.name || record.against != score.against) continue;
    const bool is_of_row = std::ranges::any_of(
        row.records, [&](std::size_t i) { return run.cells[i].cell == record.cell; });
    if (is_of_row) return &record;
  }
  return nullptr;
}

std::string difference_of_scores(const MetricRecord* before, const MetricRecord* after) {
  if (before == nullptr || after == nullptr) return "";
  if (before->version != after->version) {
    return fmt::format("version of the metric was {}, is {}", before->version, after->version);
  }
  if (before->viewing_hash != after->viewing_hash) return "the viewing conditions are others";
  if (before->reference_hash != after->reference_hash ||
      before->reference_pixel_hash != after->reference_pixel_hash) {
    return "the reference is another picture; `discern eval` scores the earlier run again";
  }
  return "";
}

std::vector<std::string> changed_parameters(const RenderRecord& before, const RenderRecord& after) {
  std::vector<std::string> changed;
  for (const auto& [name, value] : after.parameters) {
    const auto old = std::find_if(before.parameters.begin(), before.parameters.end(),
                                  [&](const auto& entry) { return entry.first == name; });
    if (old == before.parameters.end() || text_of(old->second) == text_of(value)) continue;
    changed.push_back(fmt::format("{} {} -> {}", name, text_of(old->second), text_of(value)));
  }
  return changed;
}

std::vector<std::string> stages_of(const Run& run, const SummaryRow& row) {
  std::vector<std::string> names;
  for (const std::size_t record : row.records) {
    for (const renderers::StageRecord& stage : run.cells[record].render.stages) {
      const bool is_top = stage.path.find('/') == std::string::npos && stage.path != "readback";
      if (is_top && std::ranges::find(names, stage.path) == names.end()) {
        names.push_back(stage.path);
      }
    }
  }
  return names;
}

}  // namespace results::comparison
