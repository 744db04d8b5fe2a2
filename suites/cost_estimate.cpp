#include "suites/cost_estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "perception/base/quantile.h"
#include "suites/cell_progress.h"
#include "suites/reference_images.h"

namespace suites {
namespace {

using results::RenderRecord;

/// Renders of a search, which are 1 to 8, each taken for a repetition; ours.
constexpr double kTypicalProbes = 3.0;

/// The candidates of the lowest rank; a rank is absent where one says nothing.
template <class Candidate, class Rank>
std::vector<const Candidate*> nearest(const std::vector<Candidate>& candidates, const Rank& rank,
                                      int& lowest) {
  std::vector<const Candidate*> found;
  lowest = std::numeric_limits<int>::max();
  for (const Candidate& candidate : candidates) {
    const std::optional<int> own = rank(candidate);
    if (!own || *own > lowest) continue;
    if (*own < lowest) found.clear();
    lowest = *own;
    found.push_back(&candidate);
  }
  return found;
}

/// Leaves those whose work is nearest to what is planned, within a factor of two.
template <class Candidate, class Work>
void keep_similar_work(std::vector<const Candidate*>& candidates, const Work& work,
                       double planned) {
  const auto distance = [&](const Candidate* candidate) {
    return std::abs(std::log2(work(*candidate) / planned));
  };
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate* candidate : candidates) least = std::min(least, distance(candidate));
  std::erase_if(candidates, [&](const Candidate* one) { return distance(one) > least + 1.0; });
}

/// 0 for the same in both, 1 for the same scene, 2 for the same kind of work, 3 for neither.
int rank_of(bool is_same_scene, bool is_same_work) {
  return (is_same_scene ? 0 : 2) + (is_same_work ? 0 : 1);
}

double median_of(const std::vector<const RenderRecord*>& records,
                 const std::function<double(const RenderRecord&)>& value) {
  std::vector<double> values;
  for (const RenderRecord* record : records) values.push_back(value(*record));
  return base::median(values);
}

double pixels_of(base::SizePx size) {
  return static_cast<double>(size.width) * static_cast<double>(size.height);
}

/// All parameters but the samples, which are scaled by.
bool has_same_parameters(const RenderRecord& record, const base::Parameters& parameters) {
  return std::all_of(
      parameters.entries().begin(), parameters.entries().end(), [&](const auto& entry) {
        return entry.first == "samples" ||
               std::find(record.parameters.begin(), record.parameters.end(), entry) !=
                   record.parameters.end();
      });
}

/// What one repetition of a cell is taken to cost.
class RepetitionCost {
 public:
  RepetitionCost(const PlannedCell& cell, const CostRecords& records) : cell_(cell) {
    const renderers::RendererInfo& info = *cell.method->choice.info;
    if (info.progressive_unit) {
      samples_ = cell.budget.samples;
      const base::Parameters& parameters = cell.method->choice.parameters;
      if (!samples_ && parameters.contains("samples")) samples_ = parameters.integer("samples");
    }
    int lowest_of_next = 0;
    first_ = nearest(records.repetitions, rank_by(false), lowest_);
    next_ = nearest(records.repetitions, rank_by(true), lowest_of_next);
    const auto work = [this](const RenderRecord& record) { return work_of(record); };
    keep_similar_work(first_, work, planned_work());
    keep_similar_work(next_, work, planned_work());
  }

  bool is_measured() const { return !first_.empty(); }
  bool is_of_same_scene() const { return lowest_ < 2; }
  double start_up_s() const {
    return is_measured() ? median_of(first_, [](const auto& r) { return r.start_up_s; }) : 0.0;
  }
  double prepare_s() const {
    return is_measured() ? median_of(first_, [](const auto& r) { return r.prepare_s; }) : 0.0;
  }

  double seconds(bool has_new_view) const {
    const double following = static_cast<double>(cell_.frames.size() - 1);
    const double views = has_new_view ? 2.0 : 1.0;
    if (cell_.budget.time_s) return *cell_.budget.time_s * (views + following);
    const double first_s =
        median_of(first_, [&](const auto& r) { return r.prepare_s + scaled_render_s(r) * views; });
    const double next_s =
        next_.empty()
            ? median_of(first_, [&](const auto& r) { return r.prepare_s + scaled_render_s(r); })
            : median_of(next_, [&](const auto& r) {
                return r.update_s.value_or(0.0) + scaled_render_s(r);
              });
    return first_s + following * next_s;
  }

 private:
  /// Of successes of the renderer, first frames or following ones, that can be scaled to the cell.
  std::function<std::optional<int>(const RenderRecord&)> rank_by(bool is_next) const {
    return [this, is_next](const RenderRecord& record) -> std::optional<int> {
      const bool is_usable =
          is_success(record.status) && record.renderer == cell_.method->choice.info->name &&
          record.next_frame_s.has_value() == is_next && std::isfinite(record.render_s) &&
          (is_next || std::isfinite(record.prepare_s)) && record.width_px > 0 &&
          record.height_px > 0 && (!samples_ || record.samples.value_or(0) > 0);
      if (!is_usable) return std::nullopt;
      const bool is_same_scene = std::any_of(
          cell_.frames.begin(), cell_.frames.end(),
          [&](const PlannedFrame& frame) { return frame.state->hash.hex() == record.scene_hash; });
      return rank_of(is_same_scene, has_same_parameters(record, cell_.method->choice.parameters));
    };
  }

  /// Pixels, times samples where the renderer counts them.
  double planned_work() const {
    return pixels_of(cell_.scene->size_px) * static_cast<double>(samples_.value_or(1));
  }
  double work_of(const RenderRecord& record) const {
    const double samples = samples_ ? static_cast<double>(*record.samples) : 1.0;
    return pixels_of({record.width_px, record.height_px}) * samples;
  }
  double scaled_render_s(const RenderRecord& record) const {
    return record.render_s * planned_work() / work_of(record);
  }

  const PlannedCell& cell_;
  std::optional<std::int64_t> samples_;
  std::vector<const RenderRecord*> first_;
  std::vector<const RenderRecord*> next_;
  int lowest_ = 0;
};

/// As CellProgress decides: after a long prepare a cell stays at `min`.
std::size_t most_repetitions(const MeasurePlan& measure, double prepare_s) {
  return static_cast<std::size_t>(prepare_s > kLongPrepare_s ? measure.min_repetitions
                                                             : measure.max_repetitions);
}

/// @param started  scene and method of the workers that are paid for
void add_cell(const PlannedCell& cell, const CostRecords& records,
              std::set<std::pair<const SuiteScene*, const SuiteMethod*>>& started,
              CostEstimate& estimate) {
  ++estimate.cells;
  if (cell.unsupported) return;
  const RepetitionCost cost(cell, records);
  const auto least = static_cast<std::size_t>(cell.measure.min_repetitions);
  const std::size_t most = most_repetitions(cell.measure, cost.prepare_s());
  estimate.least_repetitions += least;
  estimate.most_repetitions += most;
  if (cell.budget.time_s) {
    ++estimate.from_time_budget;
  } else if (!cost.is_measured()) {
    ++estimate.unmeasured_cells;
    return;
  } else {
    ++(cost.is_of_same_scene() ? estimate.from_same_scene : estimate.from_same_renderer);
  }
  const bool is_new_worker = started.insert({cell.scene, cell.method}).second;
  const double start_up_s = is_new_worker ? cost.start_up_s() : 0.0;
  const double repetition_s = cost.seconds(cell.measure.has_new_view);
  const bool has_search =
      cell.seed == 1 && is_searched(cell.budget, cell.method->search.has_value());
  const double search_s = has_search ? kTypicalProbes * repetition_s : 0.0;
  const double once_s = start_up_s + search_s;
  estimate.total.least_s += once_s + static_cast<double>(least) * repetition_s;
  estimate.total.most_s += once_s + static_cast<double>(most) * repetition_s;
}

void add_reference(const PlannedReference& planned, std::int64_t stored_samples,
                   const CostRecords& records, CostEstimate& estimate) {
  const ReferenceSpec spec = reference_key(planned).spec;
  const std::int64_t missing = spec.samples - stored_samples;
  if (missing <= 0) return;
  ++estimate.references;
  int lowest = 0;
  const auto rank = [&](const MeasuredReference& record) -> std::optional<int> {
    if (record.renderer != spec.renderer) return std::nullopt;
    return rank_of(record.scene_hash == planned.state->hash.hex(),
                   record.transport == to_string(planned.claims.transport));
  };
  const double work = pixels_of(planned.scene->size_px) * static_cast<double>(missing);
  auto records_nearby = nearest(records.references, rank, lowest);
  keep_similar_work(records_nearby, std::mem_fn(&MeasuredReference::pixel_samples), work);
  std::vector<double> costs;
  for (const MeasuredReference* record : records_nearby) {
    costs.push_back(record->seconds / record->pixel_samples);
  }
  if (costs.empty()) {
    ++estimate.unmeasured_references;
    return;
  }
  const double cost_s = base::median(costs) * work;
  estimate.references_s += cost_s;
  estimate.total.least_s += cost_s;
  estimate.total.most_s += cost_s;
}

}  // namespace

CostEstimate estimate_cost(const RunPlan& plan, const CostRecords& records,
                           const std::vector<std::int64_t>& stored_samples) {
  assert(stored_samples.size() == plan.references.size());
  CostEstimate estimate;
  for (std::size_t i = 0; i < plan.references.size(); ++i) {
    add_reference(plan.references[i], stored_samples[i], records, estimate);
  }
  std::set<std::pair<const SuiteScene*, const SuiteMethod*>> started;
  for (const PlannedCell& cell : plan.cells) add_cell(cell, records, started, estimate);
  return estimate;
}

std::string cost_text(double seconds) {
  if (seconds < 1.0) return "under 1 s";
  if (seconds < 59.5) return fmt::format("{:.0f} s", seconds);
  if (seconds < 3599.5) {
    const auto whole_s = std::llround(seconds);
    return fmt::format("{} min {:02} s", whole_s / 60, whole_s % 60);
  }
  const auto whole_min = std::llround(seconds / 60.0);
  return fmt::format("{} h {:02} min", whole_min / 60, whole_min % 60);
}

}  // namespace suites
