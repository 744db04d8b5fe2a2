#include "suites/run_session.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <unordered_set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "suites/budget_solver.h"
#include "suites/checkpoint_scoring.h"
#include "suites/job_cores.h"
#include "suites/planned_work.h"

namespace suites {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Adds the objects of `old` that differ from all of `now` in a key: what an earlier session with
/// another filter worked on belongs to the run, too.
void append_missing(Json& now, const Json& old, const std::vector<std::string>& keys) {
  const auto key_of = [&](const Json& entry) {
    Json values = Json::array();
    for (const std::string& key : keys) values.push_back(entry.value(key, Json()));
    return values.dump();
  };
  std::unordered_set<std::string> known;
  for (const Json& entry : now) known.insert(key_of(entry));
  for (const Json& entry : old) {
    if (known.insert(key_of(entry)).second) now.push_back(entry);
  }
}

/// No folder is made for a suite whose claims name what is not there.
RunPlan checked_plan(const Suite& suite, const std::vector<SceneStates>& scenes) {
  RunPlan plan = make_plan(suite, scenes);
  check_named_quantities(suite, scenes, plan);
  return plan;
}

}  // namespace

RunSession::RunSession(const Suite& suite, const RunOptions& options, const fs::path& folder,
                       const std::function<void(const Progress&)>& report)
    : suite_(suite),
      options_(options),
      scenes_(load_scenes(suite)),
      plan_(checked_plan(suite, scenes_)),
      folder_(results::RunFolder::open_for_writing(folder)),
      references_(options.results_root),
      meter_(report) {
  for (std::size_t i = 0; i < plan_.cells.size(); ++i) {
    if (matches_filter(plan_.cells[i], options.filter)) chosen_.push_back(i);
  }
  for (const PlannedCell& cell : plan_.cells) progress_.emplace_back(cell.frames.size());
  info_ = std::make_unique<Json>(
      describe_run(suite, scenes_, plan_, options, folder.filename().string()));
  read_earlier_work();
}

RunSession::~RunSession() = default;

void RunSession::read_earlier_work() {
  if (!fs::exists(folder_.path() / "run.json")) return;
  const results::Run earlier = results::load_run(folder_.path());
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < plan_.cells.size(); ++i) index_of[plan_.cells[i].name] = i;
  for (const results::CellRecord& record : earlier.cells) {
    const auto found = index_of.find(record.cell);
    if (found != index_of.end()) progress_[found->second].add(record);
  }
  stored_info_ = earlier.info;
  known_scores_ = earlier.metrics;
  known_checkpoint_scores_ = earlier.checkpoint_scores;
  for (const results::SearchRecord& search : earlier.searches) apply_search(search);
  // The environment and the command of a run are those it was started with.
  for (const char* key : {"environment", "command", "references", "state"}) {
    if (earlier.info->contains(key)) (*info_)[key] = earlier.info->at(key);
  }
  append_missing((*info_)["planned_cells"], earlier.info->value("planned_cells", Json::array()),
                 {"cell"});
  if (earlier.unreadable_lines > 0) (*info_)["unreadable_lines"] = earlier.unreadable_lines;
}

std::set<std::size_t> RunSession::needed_references() const {
  std::set<std::size_t> indices;
  for (const std::size_t i : chosen_) {
    const PlannedCell& cell = plan_.cells[i];
    if (cell.unsupported || suite_.metrics.empty()) continue;
    for (const PlannedFrame& frame : cell.frames) {
      indices.insert(own_reference(plan_, cell, frame));
      indices.insert(full_reference(plan_, cell, frame));
    }
  }
  return indices;
}

bool RunSession::needs_more(std::size_t cell) const {
  return progress_[cell].needs_more(plan_.cells[cell].measure);
}

/// Repetitions that the cell gets at least, from now on.
std::size_t RunSession::repetitions_to_come(std::size_t cell) const {
  if (!needs_more(cell)) return 0;
  const std::size_t done = progress_[cell].repetitions();
  const auto min = static_cast<std::size_t>(plan_.cells[cell].measure.min_repetitions);
  return min > done ? min - done : 1;
}

bool RunSession::has_work() {
  const bool has_repetitions = std::any_of(
      chosen_.begin(), chosen_.end(), [&](std::size_t i) { return repetitions_to_come(i) > 0; });
  const std::vector<std::size_t> missing = missing_scores(scoring_input());
  const bool has_scores = std::ranges::any_of(missing, [](std::size_t count) { return count > 0; });
  return has_repetitions || has_scores ||
         missing_checkpoint_scores(scoring_input(), known_checkpoint_scores_) > 0;
}

/// Announces everything that is to do, for the progress display.
void RunSession::plan_progress() {
  for (const std::size_t i : needed_references()) {
    const ReferenceKey key = reference_key(plan_.references[i]);
    meter_.plan(1, work_of_reference(*plan_.references[i].scene, references_.samples_of(key)));
  }
  // Of pictures that an interrupted run has left; then of those that are still to come.
  planned_scores_ = missing_scores(scoring_input());
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    const PlannedCell& cell = plan_.cells[chosen_[k]];
    const std::size_t count = repetitions_to_come(chosen_[k]);
    meter_.plan(count, static_cast<double>(count) * work_of_repetition(cell));
    if (!progress_[chosen_[k]].has_images() && !cell.unsupported && count > 0) {
      planned_scores_[k] = score_count(suite_, cell);
    }
    plan_scores(cell, planned_scores_[k]);
  }
}

void RunSession::plan_scores(const PlannedCell& cell, std::size_t count) {
  meter_.plan(count, static_cast<double>(count) * work_of_score(cell));
}

/// Whether run.json need not be written again: what is made of it is as new as it is.
bool RunSession::says_the_same(const Json& stored) const {
  Json now = *info_;
  now["state"] = to_string(RunState::complete);
  now["updated_utc"] = stored.value("updated_utc", "");
  return now == stored;
}

void RunSession::write_info(RunState state) {
  (*info_)["state"] = to_string(state);
  (*info_)["updated_utc"] = base::utc_now();
  folder_.write_run_json(*info_);
}

void RunSession::make_reference(const PlannedReference& planned) {
  const ReferenceKey key = reference_key(planned);
  std::string activity =
      fmt::format("reference {} {}", planned.scene->id, to_string(planned.claims.transport));
  if (planned.scene->frames.is_sequence) activity += fmt::format(" frame {}", planned.frame);
  const auto on_progress = [&](double fraction) {
    meter_.show(fraction);
    return !interrupt_requested.load();
  };
  meter_.begin_step(activity, work_of_reference(*planned.scene, references_.samples_of(key)));
  try {
    const Reference reference = references_.get(key, devices_of(options_), on_progress);
    (*info_)["references"].push_back(reference_entry(planned, key, reference));
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    (*info_)["references"].push_back(failed_reference_entry(planned, error.what()));
    ++failed_references_;
  }
}

void RunSession::make_references() {
  const Json old_references = (*info_)["references"];
  (*info_)["references"] = Json::array();
  for (const std::size_t i : needed_references()) {
    make_reference(plan_.references[i]);
    meter_.finish_step();
  }
  append_missing((*info_)["references"], old_references,
                 {"scene", "frame", "transport", "geometry_clamp"});
}

void RunSession::run_one(std::size_t cell, RepetitionRunner& runner) {
  if (interrupt_requested || has_job_failed_) throw Interrupted();
  const PlannedCell& planned = plan_.cells[cell];
  const double work = work_of_repetition(planned);
  const std::string activity = fmt::format("{} {} {} s{}", planned.scene->id, planned.method->id,
                                           planned.budget.name(), planned.seed);
  const bool is_beyond_min =
      progress_[cell].repetitions() >= static_cast<std::size_t>(planned.measure.min_repetitions);
  {
    const std::lock_guard lock(mutex_);
    if (is_beyond_min) meter_.plan(1, work);
    meter_.begin_step(activity, work);
  }
  runner.run(planned, progress_[cell], [&](double fraction) {
    if (options_.jobs == 1) meter_.show(fraction);  // steps of several jobs overlap
  });
  const std::lock_guard lock(mutex_);
  ++new_repetitions_;
  if (options_.jobs > 1) meter_.begin_step(activity, work);  // others began theirs since
  meter_.finish_step();
}

/// Interleaved: one repetition of every cell in turn, so that a drift of the machine meets all
/// methods alike. Blocks: all repetitions of a cell, then the next cell.
void RunSession::run_rounds(const std::vector<std::size_t>& cells, RepetitionRunner& runner) {
  if (!suite_.measure.is_interleaved) {
    for (const std::size_t cell : cells) {
      while (needs_more(cell)) run_one(cell, runner);
    }
    return;
  }
  for (bool is_done = false; !is_done;) {
    is_done = true;
    for (const std::size_t cell : cells) {
      if (!needs_more(cell)) continue;
      run_one(cell, runner);
      is_done = false;
    }
  }
}

/// Every seed of a (scene, method, budget) runs with what was found for the first one.
void RunSession::apply_search(const results::SearchRecord& search) {
  for (PlannedCell& cell : plan_.cells) {
    if (cell.scene->id != search.scene || cell.method->id != search.method) continue;
    if (cell.budget.name() == search.budget) apply(search, cell);
  }
}

void RunSession::solve_budgets(const SuiteScene& scene, RepetitionRunner& runner) {
  BudgetSolver solver(suite_, plan_, references_, runner);
  for (const std::size_t i : chosen_) {
    const PlannedCell& cell = plan_.cells[i];
    const bool is_solved = cell.found || cell.no_setting || cell.unsupported;
    if (cell.scene != &scene || is_solved) continue;
    if (!is_searched(cell.budget, cell.method->search.has_value())) continue;
    const std::string activity =
        fmt::format("search {} {} {}", cell.scene->id, cell.method->id, cell.budget.name());
    meter_.plan(1, work_of_repetition(cell));
    meter_.begin_step(activity, work_of_repetition(cell));
    const results::SearchRecord search = solver.solve(cell, [&](std::size_t probes) {
      meter_.show(static_cast<double>(probes) / static_cast<double>(SearchGoal{}.max_probes));
    });
    folder_.append(search);
    apply_search(search);
    meter_.finish_step();
  }
}

/// Chosen cells that have something to do, by (scene, method), the most work first.
std::vector<std::vector<std::size_t>> RunSession::cells_by_worker() const {
  using Key = std::pair<const SuiteScene*, const SuiteMethod*>;
  std::map<Key, std::size_t> index_of;
  std::vector<std::vector<std::size_t>> groups;
  std::vector<double> work;
  for (const std::size_t i : chosen_) {
    const PlannedCell& cell = plan_.cells[i];
    const std::size_t count = repetitions_to_come(i);
    if (count == 0) continue;
    const auto [entry, is_new] = index_of.try_emplace({cell.scene, cell.method}, groups.size());
    if (is_new) {
      groups.emplace_back();
      work.push_back(0.0);
    }
    groups[entry->second].push_back(i);
    work[entry->second] += static_cast<double>(count) * work_of_repetition(cell);
  }
  std::vector<std::size_t> order(groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return work[i]; });
  std::vector<std::vector<std::size_t>> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(groups[i]));
  return sorted;
}

/// Settings are found one by one, on as many cores as they are measured with; then every job takes
/// one worker's cells after another.
void RunSession::run_repetitions_in_jobs() {
  const std::vector<std::vector<int>> cores = cores_of_jobs(available_cores(), options_.jobs);
  run_on_cores(cores.front(), [&] {
    RepetitionRunner runner(suite_, options_, folder_);
    for (const SuiteScene& scene : suite_.scenes) {
      solve_budgets(scene, runner);
      runner.close_workers();
    }
  });
  const std::vector<std::vector<std::size_t>> groups = cells_by_worker();
  std::atomic<std::size_t> next = 0;
  const auto work = [&](int) {
    RepetitionRunner runner(suite_, options_, folder_);
    for (std::size_t i = next++; i < groups.size(); i = next++) {
      run_rounds(groups[i], runner);
      runner.close_workers();
    }
  };
  run_jobs(cores, work, [this] { has_job_failed_ = true; });
}

void RunSession::run_repetitions() {
  if (options_.jobs > 1) {
    run_repetitions_in_jobs();
    return;
  }
  RepetitionRunner runner(suite_, options_, folder_);
  for (const SuiteScene& scene : suite_.scenes) {
    std::vector<std::size_t> cells;
    for (const std::size_t i : chosen_) {
      if (plan_.cells[i].scene == &scene) cells.push_back(i);
    }
    solve_budgets(scene, runner);
    run_rounds(cells, runner);
    runner.close_workers();
  }
}

void RunSession::make_scores() {
  const std::vector<std::size_t> missing = missing_scores(scoring_input());
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    const std::size_t planned = std::min(planned_scores_[k], missing[k]);
    plan_scores(plan_.cells[chosen_[k]], missing[k] - planned);
  }
  meter_.plan(missing_checkpoint_scores(scoring_input(), known_checkpoint_scores_), 0.0);
  ScoringOutcome scoring = score_cells(scoring_input(), folder_, meter_);
  score_checkpoints(scoring_input(), known_checkpoint_scores_, folder_, meter_, scoring);
  info_->erase("score_failures");
  if (!scoring.failures.empty()) (*info_)["score_failures"] = scoring.failures;
  failed_scores_ = scoring.failures.size();
}

RunOutcome RunSession::outcome() const {
  RunOutcome outcome;
  outcome.run_folder = folder_.path();
  outcome.cells = chosen_.size();
  outcome.new_repetitions = new_repetitions_;
  outcome.failed_references = failed_references_;
  outcome.failed_scores = failed_scores_;
  outcome.was_interrupted = was_interrupted_;
  for (const std::size_t i : chosen_) {
    outcome.finished_repetitions += progress_[i].repetitions();
    if (progress_[i].has_failed()) ++outcome.failed_cells;
    if (progress_[i].was_skipped()) ++outcome.skipped_cells;
  }
  return outcome;
}

RunOutcome RunSession::run() {
  folder_.write_resolved_suite(resolved_yaml(suite_));
  if (!has_work()) {
    if (stored_info_ == nullptr || !says_the_same(*stored_info_)) write_info(RunState::complete);
    return outcome();
  }
  write_info(RunState::running);
  plan_progress();
  try {
    make_references();
    write_info(RunState::running);
    run_repetitions();
    make_scores();
    write_info(RunState::complete);
  } catch (const Interrupted&) {
    was_interrupted_ = true;
    write_info(RunState::interrupted);
  }
  return outcome();
}

/// What run.json says of the references is what the scores are made against.
void RunSession::describe_stored_references() {
  const Json old_references = (*info_)["references"];
  (*info_)["references"] = Json::array();
  for (const std::size_t i : needed_references()) {
    const PlannedReference& planned = plan_.references[i];
    const ReferenceKey key = reference_key(planned);
    const std::optional<Reference> stored = references_.load(key);
    if (stored) (*info_)["references"].push_back(reference_entry(planned, key, *stored));
  }
  append_missing((*info_)["references"], old_references,
                 {"scene", "frame", "transport", "geometry_clamp"});
}

/// A stored image is scored only against what is there with as many samples as asked.
void RunSession::check_references(const PlannedCell& cell, const CellProgress& progress) const {
  for (const PlannedFrame& frame : cell.frames) {
    if (progress.image(frame.frame).empty()) continue;
    for (const std::size_t index :
         {own_reference(plan_, cell, frame), full_reference(plan_, cell, frame)}) {
      const ReferenceKey key = reference_key(plan_.references[index]);
      if (references_.contains(key)) continue;
      throw base::InputError(fmt::format(
          "scene {}: the reference for transport {} has {} of {} samples; render it with `discern "
          "ref build`",
          cell.scene->id, to_string(key.claims.transport), references_.samples_of(key),
          key.spec.samples));
    }
  }
}

std::size_t RunSession::evaluate() {
  for (const std::size_t i : chosen_) check_references(plan_.cells[i], progress_[i]);
  if (options_.force) {
    known_scores_.clear();
    known_checkpoint_scores_.clear();
  }
  for (const std::size_t i : chosen_) {
    const PlannedCell& cell = plan_.cells[i];
    if (!progress_[i].has_images()) continue;
    plan_scores(cell, score_count(suite_, cell));
  }
  describe_stored_references();
  ScoringOutcome scoring = score_cells(scoring_input(), folder_, meter_);
  score_checkpoints(scoring_input(), known_checkpoint_scores_, folder_, meter_, scoring);
  folder_.write_run_json(*info_);
  return scoring.scores;
}

}  // namespace suites
