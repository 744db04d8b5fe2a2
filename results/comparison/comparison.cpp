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

Quantity time_quantity(const std::string& name, bool is_first_frame) {
  Quantity quantity;
  quantity.kind = Quantity::Kind::time;
  quantity.name = name;
  quantity.is_first_frame = is_first_frame;
  quantity.text = is_first_frame ? "first." + name : name;
  quantity.unit = "s";
  return quantity;
}

Quantity stage_quantity(const std::string& name) {
  Quantity quantity;
  quantity.kind = Quantity::Kind::stage;
  quantity.name = name;
  quantity.text = name;
  quantity.unit = "s";
  return quantity;
}

Quantity score_quantity(const std::string& metric, const std::string& against) {
  Quantity quantity;
  quantity.kind = Quantity::Kind::score;
  quantity.name = metric;
  quantity.against = against;
  quantity.text = against == "full" ? metric + "@full" : metric;
  return quantity;
}

class Comparer {
 public:
  Comparer(const RunValues& before, const RunValues& after, const Rules& rules)
      : before_(before), after_(after), rules_(rules) {}

  Comparison compare();

 private:
  Change empty_change(const RowPair& pair, const Quantity& quantity) const;
  void add_row(const RowPair& pair);
  bool add_failure(const RowPair& pair);
  void add_times(const RowPair& pair, const std::string& why_not);
  void add_time(const RowPair& pair, const Quantity& quantity, const std::string& why_not,
                std::vector<Change>& changes);
  void test_times(const std::vector<double>& before, const std::vector<double>& after,
                  Change& change) const;
  void add_scores(const RowPair& pair);
  void add_score(const RowPair& pair, const std::string& metric, const std::string& against);
  void fill_score(const RowPair& pair, const Quantity& quantity, Change& change) const;
  bool uses_seed(const std::string& method) const;
  void adjust(std::vector<Change>& changes, std::size_t begin) const;
  void judge(Change& change) const;
  void add_stages(const RowPair& pair);
  void add_overall();
  void add_load_note(const Run& run, const char* which);

  const RunValues& before_;
  const RunValues& after_;
  Rules rules_;
  Comparison result_;
  std::set<std::string> parameter_notes_;
};

Change Comparer::empty_change(const RowPair& pair, const Quantity& quantity) const {
  Change change;
  change.scene = pair.any().scene;
  change.method = pair.any().method;
  change.budget = pair.any().budget;
  change.quantity = quantity.text;
  change.unit = quantity.unit;
  return change;
}

Comparison Comparer::compare() {
  const std::vector<RowPair> pairs = paired_rows(before_.summary(), after_.summary());
  for (const RowPair& pair : pairs) add_row(pair);
  adjust(result_.changes, 0);
  for (Change& change : result_.changes) judge(change);
  for (const RowPair& pair : pairs) add_stages(pair);
  add_overall();
  for (const std::string& note : parameter_notes_) result_.notes.push_back("differs: " + note);
  add_load_note(before_.run(), "earlier");
  add_load_note(after_.run(), "later");
  return std::move(result_);
}

void Comparer::add_row(const RowPair& pair) {
  Change change = empty_change(pair, time_quantity("total_s", false));
  if (pair.before == nullptr || pair.after == nullptr) {
    change.verdict = Verdict::not_measured;
    change.reason = pair.before == nullptr ? "only in the later run" : "only in the earlier run";
    result_.changes.push_back(std::move(change));
    return;
  }
  if (add_failure(pair)) return;
  const CellRecord* before = first_record(before_.run(), *pair.before);
  const CellRecord* after = first_record(after_.run(), *pair.after);
  if (before == nullptr || after == nullptr) {
    change.verdict = Verdict::not_measured;
    change.reason = before == nullptr ? "no record in the earlier run" : "no record yet";
    result_.changes.push_back(std::move(change));
    return;
  }
  const std::string pictures = difference_of_pictures(before->render, after->render);
  if (!pictures.empty()) {
    change.verdict = Verdict::invalid;
    change.reason = pictures;
    result_.changes.push_back(std::move(change));
    return;
  }
  for (const std::string& parameter : changed_parameters(before->render, after->render)) {
    parameter_notes_.insert(fmt::format("{}: {}", pair.after->method, parameter));
  }
  add_times(pair, difference_of_machines(*before, *after));
  add_scores(pair);
}

/// Failures and skips, before anything is compared. @return whether the row is dealt with
bool Comparer::add_failure(const RowPair& pair) {
  const auto has_result = [](const SummaryRow& row) {
    return !row.has_failure() && row.total_s.has_value();
  };
  const bool was = has_result(*pair.before);
  const bool is = has_result(*pair.after);
  if (was && is) return false;
  Change change = empty_change(pair, time_quantity("total_s", false));
  change.quantity = "status";
  change.unit = "";
  const std::string statuses =
      fmt::format("was {}, is {}", format_statuses(*pair.before), format_statuses(*pair.after));
  if (was == is) {
    change.verdict = pair.after->has_failure() ? Verdict::invalid : Verdict::not_measured;
  } else if (is) {
    change.verdict = pair.before->has_failure() ? Verdict::better : Verdict::not_measured;
  } else {
    change.verdict = pair.after->has_failure() ? Verdict::worse : Verdict::not_measured;
  }
  change.reason = statuses;
  result_.changes.push_back(std::move(change));
  return true;
}

void Comparer::add_times(const RowPair& pair, const std::string& why_not) {
  std::vector<Change>& changes = result_.changes;
  const bool is_sequence = pair.after->is_sequence;
  add_time(pair, time_quantity("total_s", is_sequence), why_not, changes);
  if (is_sequence) add_time(pair, time_quantity("next_frame_s", false), why_not, changes);
  if (pair.before->new_view_s && pair.after->new_view_s) {
    add_time(pair, time_quantity("new_view_s", false), why_not, changes);
  }
}

void Comparer::add_time(const RowPair& pair, const Quantity& quantity, const std::string& why_not,
                        std::vector<Change>& changes) {
  const std::vector<double> before =
      values_over_frames(before_.samples(pair.before_index, quantity));
  const std::vector<double> after = values_over_frames(after_.samples(pair.after_index, quantity));
  const auto is_positive = [](double value) { return value > 0.0; };
  if (before.empty() || after.empty() || !std::ranges::all_of(before, is_positive) ||
      !std::ranges::all_of(after, is_positive)) {
    return;
  }
  Change change = empty_change(pair, quantity);
  change.before = before_.estimate(pair.before_index, quantity);
  change.after = after_.estimate(pair.after_index, quantity);
  change.ratio = ratio_of_medians(before, after);
  if (!why_not.empty()) {
    change.verdict = Verdict::invalid;
    change.reason = why_not;
  } else {
    test_times(before, after, change);
  }
  changes.push_back(std::move(change));
}

/// Welch's test has the power to stay significant among many rows, the rank-sum test holds whatever
/// the distribution is: a change needs both.
void Comparer::test_times(const std::vector<double>& before, const std::vector<double>& after,
                          Change& change) const {
  if (before.size() < 2 || after.size() < 2) {
    change.reason = "a single repetition; two or more tell the noise";
    return;
  }
  change.p = welch_log_p(before, after);
  const double least = least_rank_sum_p(before.size(), after.size());
  if (least > rules_.alpha) {
    change.is_rank_significant = false;
    change.reason =
        fmt::format("{} and {} repetitions cannot show a change at alpha {:g}; {} of each can",
                    before.size(), after.size(), rules_.alpha, fewest_repetitions(rules_.alpha));
    return;
  }
  change.is_rank_significant = rank_sum_p(before, after) <= rules_.alpha;
}

void Comparer::add_scores(const RowPair& pair) {
  for (const std::string& metric : after_.summary().metrics) {
    for (const char* against : {"own", "full"}) {
      const ScoreSummary* after = pair.after->find_score(metric, against);
      const ScoreSummary* before = pair.before->find_score(metric, against);
      if (before == nullptr || after == nullptr || !before->is_wanted || !after->is_wanted)
        continue;
      add_score(pair, metric, against);
    }
  }
}

/// The score per seed, of those that both runs have.
std::vector<std::pair<double, double>> paired_seeds(const std::vector<Sample>& before,
                                                    const std::vector<Sample>& after,
                                                    bool is_mean) {
  const auto by_seed = [&](const std::vector<Sample>& samples) {
    std::map<std::uint64_t, std::vector<Sample>> seeds;
    for (const Sample& sample : samples) seeds[sample.seed].push_back(sample);
    std::map<std::uint64_t, double> values;
    for (const auto& [seed, list] : seeds) values[seed] = values_over_frames(list, is_mean).front();
    return values;
  };
  const auto left = by_seed(before);
  std::vector<std::pair<double, double>> pairs;
  for (const auto& [seed, value] : by_seed(after)) {
    const auto found = left.find(seed);
    if (found != left.end()) pairs.emplace_back(found->second, value);
  }
  return pairs;
}

void Comparer::add_score(const RowPair& pair, const std::string& metric,
                         const std::string& against) {
  const Quantity quantity = score_quantity(metric, against);
  Change change = empty_change(pair, quantity);
  if (const metrics::MetricDescription* info = metric_info_of(metric)) {
    change.unit = info->unit;
    if (info->better == metrics::Better::higher) change.better = Direction::higher;
  }
  change.before = before_.estimate(pair.before_index, quantity);
  change.after = after_.estimate(pair.after_index, quantity);
  if (!change.before && !change.after) return;
  if (!change.before || !change.after) {
    // Not a number, or of a picture identical to its reference: no ratio, and no silence about it.
    change.verdict = Verdict::not_measured;
    change.reason =
        fmt::format("no finite score in the {} run", change.before ? "later" : "earlier");
    result_.changes.push_back(std::move(change));
    return;
  }
  // Where a method claims all light, both scores are the same one.
  const auto& changes = result_.changes;
  if (against == "full" && !changes.empty() && changes.back().quantity == metric &&
      changes.back().method == change.method && changes.back().scene == change.scene &&
      changes.back().budget == change.budget && changes.back().before && changes.back().after &&
      changes.back().before->value == change.before->value &&
      changes.back().after->value == change.after->value) {
    return;
  }
  fill_score(pair, quantity, change);
  result_.changes.push_back(std::move(change));
}

void Comparer::fill_score(const RowPair& pair, const Quantity& quantity, Change& change) const {
  const auto seeds =
      paired_seeds(before_.samples(pair.before_index, quantity),
                   after_.samples(pair.after_index, quantity), is_sequence_metric(quantity.name));
  if (seeds.empty()) {
    change.verdict = Verdict::invalid;
    change.reason = "no seed in common";
    return;
  }
  if (std::ranges::all_of(seeds, [](const auto& s) { return s.first == s.second; })) {
    change.ratio = Estimate{1.0, 1.0, 1.0, seeds.size()};
    change.verdict = Verdict::same;
    change.reason = "equal";
    return;
  }
  const bool is_positive =
      std::ranges::all_of(seeds, [](const auto& s) { return s.first > 0.0 && s.second > 0.0; });
  std::vector<double> differences;
  std::vector<double> ratios;
  for (const auto& [before, after] : seeds) {
    differences.push_back(is_positive ? std::log(after) - std::log(before) : after - before);
    if (is_positive) ratios.push_back(after / before);
  }
  if (is_positive) change.ratio = geometric_mean(ratios);
  if (!uses_seed(pair.after->method)) {
    change.p = 0.0;
    change.reason = "no random numbers";
  } else if (seeds.size() >= 2) {
    change.p = paired_t_p(differences);
  } else {
    change.reason = "one seed in common; two or more tell the noise of the estimator";
  }
}

bool Comparer::uses_seed(const std::string& method) const {
  const ordered_json& info = *after_.run().info;
  const auto methods = info.find("methods");
  if (methods == info.end() || !methods->is_array()) return true;
  for (const ordered_json& entry : *methods) {
    if (entry.is_object() && entry.value("id", "") == method) return entry.value("uses_seed", true);
  }
  return true;
}

void Comparer::adjust(std::vector<Change>& changes, std::size_t begin) const {
  std::vector<double> p;
  for (std::size_t i = begin; i < changes.size(); ++i) {
    if (changes[i].p) p.push_back(*changes[i].p);
  }
  const std::vector<double> q = adjusted_for_false_discovery(p);
  std::size_t next = 0;
  for (std::size_t i = begin; i < changes.size(); ++i) {
    if (changes[i].p) changes[i].q = q[next++];
  }
}

void Comparer::judge(Change& change) const {
  if (change.verdict != Verdict::inconclusive) return;
  const bool is_time = change.unit == "s";
  const double effect = is_time ? rules_.time_effect : rules_.score_effect;
  const bool is_greater = change.after->value > change.before->value;
  const bool is_worse = is_greater == (change.better != Direction::higher);
  // Without a ratio one of the scores is not above 0: any change is beyond a share of that.
  const double ratio = change.ratio ? change.ratio->value : 0.0;
  const bool is_large = ratio <= 0.0 || std::max(ratio, 1.0 / ratio) >= 1.0 + effect;
  const bool is_significant = change.q && *change.q <= rules_.alpha && change.is_rank_significant;
  if (is_significant && is_large) {
    change.verdict = is_worse ? Verdict::worse : Verdict::better;
    return;
  }
  const bool has_interval = change.p.has_value();
  if (has_interval && change.ratio && change.ratio->low >= 1.0 / (1.0 + effect) &&
      change.ratio->high <= 1.0 + effect) {
    change.verdict = Verdict::same;
    change.reason.clear();
    return;
  }
  if (!change.reason.empty() && !is_significant) return;
  change.reason = is_significant ? fmt::format("a change, but maybe below {:g} %", 100.0 * effect)
                                 : fmt::format("may be a change of {:g} % or none", 100.0 * effect);
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
  for (const std::string& name : stages_of(after_.run(), *pair.after)) {
    add_time(pair, stage_quantity(name), "", stages);
  }
  adjust(stages, 0);
  for (Change& stage : stages) judge(stage);
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

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::worse:
      return "worse";
    case Verdict::better:
      return "better";
    case Verdict::same:
      return "same";
    case Verdict::inconclusive:
      return "inconclusive";
    case Verdict::invalid:
      return "invalid";
    case Verdict::not_measured:
      break;
  }
  return "not_measured";
}

std::size_t Comparison::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      changes, [verdict](const Change& change) { return change.verdict == verdict; }));
}

Comparison compare(const RunValues& before, const RunValues& after, const Rules& rules) {
  return Comparer(before, after, rules).compare();
}

}  // namespace results::comparison
