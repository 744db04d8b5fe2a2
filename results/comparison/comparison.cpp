#include "results/comparison/comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "results/comparison/row_pairs.h"
#include "results/comparison/significance.h"

namespace results::comparison {

namespace {

using nlohmann::ordered_json;

bool has_equal_scores(const Change& a, const Change& b) {
  return a.before && a.after && b.before && b.after && a.before->value == b.before->value &&
         a.after->value == b.after->value;
}

class Comparer {
 public:
  Comparer(const RunValues& before, const RunValues& after, const Rules& rules)
      : runs_{before, after, rules.is_by_canary}, rules_(rules) {}

  Comparison compare();

 private:
  void add_row(const RowPair& pair);
  void add_times(const RowPair& pair);
  void add_time(const RowPair& pair, const Quantity& quantity, std::vector<Change>& changes);
  void add_scores(const RowPair& pair);
  void judge_all(std::vector<Change>& changes) const;
  void add_stages(const RowPair& pair);
  void add_overall();
  void add_load_note(const Run& run, const char* which);
  void add_canary_note();

  ComparedRuns runs_;
  Rules rules_;
  Comparison result_;
  std::set<std::string> parameter_notes_;
};

Comparison Comparer::compare() {
  const std::vector<RowPair> pairs = paired_rows(runs_.before.summary(), runs_.after.summary());
  for (const RowPair& pair : pairs) add_row(pair);
  judge_all(result_.changes);
  for (const RowPair& pair : pairs) add_stages(pair);
  add_overall();
  for (const std::string& note : parameter_notes_) result_.notes.push_back("differs: " + note);
  add_load_note(runs_.before.run(), "earlier");
  add_load_note(runs_.after.run(), "later");
  add_canary_note();
  return std::move(result_);
}

void Comparer::judge_all(std::vector<Change>& changes) const {
  adjust_for_false_discovery(changes);
  for (Change& change : changes) {
    const bool is_time = change.unit == "s";
    judge(change, rules_.alpha, is_time ? rules_.time_effect : rules_.score_effect);
  }
}

void Comparer::add_row(const RowPair& pair) {
  if (std::optional<Change> change = obstacle(runs_, pair)) {
    result_.changes.push_back(std::move(*change));
    return;
  }
  const CellRecord* before = first_record(runs_.before.run(), *pair.before);
  const CellRecord* after = first_record(runs_.after.run(), *pair.after);
  for (const std::string& parameter : changed_parameters(before->render, after->render)) {
    parameter_notes_.insert(fmt::format("{}: {}", pair.after->method, parameter));
  }
  add_times(pair);
  add_scores(pair);
}

void Comparer::add_times(const RowPair& pair) {
  std::vector<Change>& changes = result_.changes;
  const bool is_sequence = pair.after->is_sequence;
  add_time(pair, time_quantity("total_s", is_sequence), changes);
  if (is_sequence) add_time(pair, time_quantity("next_frame_s", false), changes);
  if (pair.before->new_view_s && pair.after->new_view_s) {
    add_time(pair, time_quantity("new_view_s", false), changes);
  }
}

void Comparer::add_time(const RowPair& pair, const Quantity& quantity,
                        std::vector<Change>& changes) {
  std::optional<Change> change = time_change(runs_, pair, quantity, rules_.alpha);
  if (change) changes.push_back(std::move(*change));
}

void Comparer::add_scores(const RowPair& pair) {
  for (const std::string& metric : runs_.after.summary().metrics) {
    std::optional<Change> own;
    for (const char* against : {"own", "full"}) {
      const ScoreSummary* after = pair.after->find_score(metric, against);
      const ScoreSummary* before = pair.before->find_score(metric, against);
      if (before == nullptr || after == nullptr || !before->is_wanted || !after->is_wanted)
        continue;
      std::optional<Change> change = score_change(runs_, pair, score_quantity(metric, against));
      // Where a method claims all light, both scores are the same one.
      if (!change || (own && has_equal_scores(*own, *change))) continue;
      own = change;
      result_.changes.push_back(std::move(*change));
    }
  }
}

/// Which stages moved, in rows whose time did.
void Comparer::add_stages(const RowPair& pair) {
  if (pair.before == nullptr || pair.after == nullptr) return;
  const bool has_moved = std::ranges::any_of(result_.changes, [&](const Change& change) {
    return change.scene == pair.after->scene && change.method == pair.after->method &&
           change.budget == pair.after->budget && change.unit == "s" &&
           (change.verdict == Verdict::worse || change.verdict == Verdict::better);
  });
  if (!has_moved) return;
  std::vector<Change> stages;
  for (const std::string& name : stages_of(runs_.after.run(), *pair.after)) {
    add_time(pair, stage_quantity(name), stages);
  }
  judge_all(stages);
  std::ranges::stable_sort(stages, std::greater<>(), [](const Change& stage) {
    return std::fabs(stage.after->value - stage.before->value);
  });
  for (Change& stage : stages) result_.stages.push_back(std::move(stage));
}

/// Times of a machine with other work to do are no basis for a verdict; scores are.
void Comparer::add_load_note(const Run& run, const char* which) {
  constexpr double kBusyShare = 0.5;  // of the cores; ours
  const auto environment = run.info->find("environment");
  if (environment == run.info->end() || !environment->is_object()) return;
  const auto load = environment->find("load_average");
  const auto cores = environment->find("cores");
  if (load == environment->end() || cores == environment->end() || !load->is_array() ||
      load->empty() || !cores->is_number()) {
    return;
  }
  const auto last_minute = load->front().get<double>();
  if (last_minute <= kBusyShare * cores->get<double>()) return;
  result_.notes.push_back(fmt::format(
      "the machine was busy when the {} run began (load {:.1f} on {} cores): its times are those "
      "of other work as well",
      which, last_minute, cores->get<int>()));
}

/// Times of the fixed work that every repetition waits for.
std::vector<double> canaries_of(const Run& run) {
  std::vector<double> times;
  for (const CellRecord& record : run.cells) {
    if (record.canary_s) times.push_back(*record.canary_s);
  }
  return times;
}

void Comparer::add_canary_note() {
  const std::vector<double> before = canaries_of(runs_.before.run());
  const std::vector<double> after = canaries_of(runs_.after.run());
  if (before.empty() || after.empty()) return;
  const Estimate ratio = ratio_of_medians(before, after);
  const bool is_drift = std::max(ratio.value, 1.0 / ratio.value) >= 1.0 + rules_.time_effect;
  if (!runs_.is_by_canary && !is_drift) return;
  result_.notes.push_back(
      fmt::format("canary: the machine was {:.1f} % {} in the later run [{:.1f}, {:.1f}]; {}",
                  100.0 * std::fabs(ratio.value - 1.0), ratio.value > 1.0 ? "slower" : "faster",
                  100.0 * (ratio.low - 1.0), 100.0 * (ratio.high - 1.0),
                  runs_.is_by_canary ? "later times are divided by that, row by row"
                                     : "--canary takes that out of the times"));
}

void Comparer::add_overall() {
  using Key = std::tuple<std::string, std::string, std::string>;
  std::vector<Key> order;
  std::map<Key, std::vector<double>> ratios;
  for (const Change& change : result_.changes) {
    if (!change.ratio || change.verdict == Verdict::invalid) continue;
    const Key key{change.method, change.budget, change.quantity};
    if (!ratios.contains(key)) order.push_back(key);
    ratios[key].push_back(change.ratio->value);
  }
  for (const Key& key : order) {
    if (ratios[key].size() < 2) continue;
    result_.overall.push_back(
        {std::get<0>(key), std::get<1>(key), std::get<2>(key), geometric_mean(ratios[key])});
  }
}

}  // namespace

std::size_t Comparison::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      changes, [verdict](const Change& change) { return change.verdict == verdict; }));
}

Comparison compare(const RunValues& before, const RunValues& after, const Rules& rules) {
  return Comparer(before, after, rules).compare();
}

}  // namespace results::comparison
