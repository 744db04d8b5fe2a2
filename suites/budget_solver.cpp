#include "suites/budget_solver.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "perception/base/quantile.h"
#include "perception/base/units.h"
#include "perception/image_file.h"
#include "suites/scoring.h"

namespace suites {
namespace {

/// Probes that the time of another method is the median of.
constexpr int kTimeProbes = 3;

std::string shown(double value) { return base::format_significant(value, 4); }

/// "16", "0.125": as the suite would state it.
std::string as_stated(double value) { return fmt::format("{:.6g}", value); }

}  // namespace

struct BudgetSolver::Failure : std::runtime_error {
  Failure(std::string outcome_, const std::string& reason)
      : std::runtime_error(reason), outcome(std::move(outcome_)) {}
  std::string outcome;
};

SearchedSetting searched_setting(const PlannedCell& cell) {
  return cell.method->search.value_or(SearchedSetting{});
}

void apply(const results::SearchRecord& search, PlannedCell& cell) {
  if (!search.value) {
    cell.no_setting = search.reason;
    return;
  }
  cell.found = FoundSetting{search.setting, *search.value};
}

perception::ViewingConditions BudgetSolver::viewing(const PlannedCell& cell) const {
  return viewing_of(suite_, *cell.frames.front().state);
}

/// The time of one probe: of a sequence the median of its following frames.
double BudgetSolver::median_time_s(const PlannedCell& cell) {
  const ProbeOutcome probe = runner_.probe(cell);
  if (!probe.failure.empty()) throw Failure("failed", probe.failure);
  std::vector<double> times;
  const bool is_sequence = cell.frames.size() > 1;
  for (const ProbedFrame& frame : probe.frames) {
    if (frame.record.next_frame_s.has_value() == is_sequence)
      times.push_back(timed_s(frame.record));
  }
  return base::median(times);
}

double BudgetSolver::time_target_s(const PlannedCell& cell) {
  if (cell.budget.time_s) return *cell.budget.time_s;
  for (const PlannedCell& other : plan_.cells) {
    const bool is_target = other.scene == cell.scene && other.method->id == cell.budget.time_of &&
                           other.seed == cell.seed;
    if (!is_target || is_searched(other.budget, other.method->search.has_value())) continue;
    if (other.unsupported) throw Failure("failed", *other.unsupported);
    std::vector<double> times;
    for (int i = 0; i < kTimeProbes; ++i) times.push_back(median_time_s(other));
    runner_.end_probes(other);
    return base::median(times);
  }
  throw Failure("failed", fmt::format("method \"{}\" has no budget of its own here that is not "
                                      "searched, so there is no time to be equal to",
                                      cell.budget.time_of));
}

SearchGoal BudgetSolver::goal_of(const PlannedCell& cell) {
  const SearchedSetting setting = searched_setting(cell);
  SearchGoal goal;
  goal.from = setting.from;
  goal.to = setting.to;
  goal.is_whole = setting.is_whole;
  if (cell.budget.error) {
    const base::Place place{suite_.file.string(), 0, 0};
    const auto choice = metrics::parse_metric_choice(cell.budget.error->metric, place);
    goal.law = is_error(*choice.info) ? SearchGoal::Law::error : SearchGoal::Law::score;
    goal.target = cell.budget.error->at;
    check_noise_floor(cell, goal);
  } else {
    goal.target = time_target_s(cell);
  }
  return goal;
}

/// An error below the reference's own noise cannot be told from that noise: it is not chased.
void BudgetSolver::check_noise_floor(const PlannedCell& cell, const SearchGoal& goal) {
  const PlannedFrame& frame = cell.frames.front();
  const ReferencePart truth{own_reference(plan_, cell, frame), frame.claims.part};
  const auto reference = references_.get(truth);
  const auto choice = metrics::parse_metric_choice(cell.budget.error->metric, {});
  const std::optional<double> floor = noise_floor(*reference, truth.part, choice, viewing(cell));
  if (!floor) return;
  const bool is_below =
      choice.info->better == metrics::Better::lower ? goal.target <= *floor : goal.target >= *floor;
  if (!is_below) return;
  throw Failure(
      "below_noise_floor",
      fmt::format("{} of {} asks for less than the noise of the reference, {} with {} "
                  "samples; accepted: a target beyond that, or more reference samples",
                  choice.text, as_stated(goal.target), shown(*floor), reference->samples));
}

double BudgetSolver::score(const PlannedCell& cell, const ProbedFrame& frame, std::size_t index) {
  const PlannedFrame& planned = cell.frames[index];
  const ReferencePart truth{own_reference(plan_, cell, planned), planned.claims.part};
  const auto choice = metrics::parse_metric_choice(cell.budget.error->metric, {});
  const auto reference = references_.get(truth);
  const perception::Image image = perception::rgb_of(perception::read_image(frame.image));
  return metrics::score(choice, {reference->image(truth.part), image}, viewing(cell),
                        {false, false})
      .value;
}

/// What the budget asks for, at a setting.
double BudgetSolver::measured(const PlannedCell& cell, double setting) {
  PlannedCell probed = cell;
  const SearchedSetting searched = searched_setting(cell);
  probed.found = FoundSetting{searched.name, setting};
  if (!cell.budget.error) return median_time_s(probed);
  const ProbeOutcome probe = runner_.probe(probed);
  if (!probe.failure.empty()) throw Failure("failed", probe.failure);
  std::vector<double> scores;
  for (std::size_t i = 0; i < probe.frames.size(); ++i) {
    scores.push_back(score(probed, probe.frames[i], i));
  }
  const double value = base::median(scores);
  if (std::isfinite(value)) return value;
  throw Failure("failed", fmt::format("{} at {} {} is not finite", cell.budget.error->metric,
                                      searched.name, as_stated(setting)));
}

namespace {

/// Why a search without a setting ended.
std::string reason_of(SettingSearch::End end, const results::SearchRecord& record, double at,
                      double measured) {
  const bool is_time = record.quantity == "total_s" || record.quantity == "next_frame_s";
  const std::string unit = is_time ? " s" : "";
  const bool is_least = end == SettingSearch::End::below_reach;
  return fmt::format("{} {}, the {} that search allows, gives {} {}{}; the target is {}{}",
                     record.setting, as_stated(at), is_least ? "least" : "most", record.quantity,
                     shown(measured), unit, shown(record.target), unit);
}

}  // namespace

results::SearchRecord BudgetSolver::solve(const PlannedCell& cell,
                                          const std::function<void(std::size_t)>& show) {
  results::SearchRecord record;
  record.scene = cell.scene->id;
  record.method = cell.method->id;
  record.budget = cell.budget.name();
  record.setting = searched_setting(cell).name;
  const bool is_sequence = cell.frames.size() > 1;
  record.quantity =
      cell.budget.error ? cell.budget.error->metric : (is_sequence ? "next_frame_s" : "total_s");
  record.target = cell.budget.error ? cell.budget.error->at : cell.budget.time_s.value_or(NAN);
  try {
    const SearchGoal goal = goal_of(cell);
    record.target = goal.target;
    SettingSearch search(goal);
    while (const std::optional<double> setting = search.next()) {
      search.add(measured(cell, *setting));
      record.probes.push_back({*setting, search.probes().back().measured});
      if (show) show(search.probes().size());
    }
    const SettingSearch::End end = search.end();
    record.outcome = to_string(end);
    record.achieved = search.best().measured;
    if (end == SettingSearch::End::met || end == SettingSearch::End::nearest) {
      record.value = search.best().setting;
    } else {
      record.reason = reason_of(end, record, search.best().setting, search.best().measured);
    }
  } catch (const Failure& failure) {
    record.outcome = failure.outcome;
    record.reason = failure.what();
  } catch (const base::InputError& error) {
    record.outcome = "failed";
    record.reason = error.what();
  }
  runner_.end_probes(cell);
  return record;
}

}  // namespace suites
