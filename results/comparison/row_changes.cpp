#include "results/comparison/row_changes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/quantile.h"
#include "results/comparison/significance.h"

namespace results::comparison {

namespace {

using nlohmann::ordered_json;

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

/// Whether the pictures of a method depend on the seed, as the later run's run.json says.
bool uses_seed(const Run& run, const std::string& method) {
  const auto methods = run.info->find("methods");
  if (methods == run.info->end() || !methods->is_array()) return true;
  for (const ordered_json& entry : *methods) {
    if (entry.is_object() && entry.value("id", "") == method) return entry.value("uses_seed", true);
  }
  return true;
}

void test_times(const std::vector<double>& before, const std::vector<double>& after, double alpha,
                Change& change) {
  if (before.size() < 2 || after.size() < 2) {
    change.reason = "a single repetition; two or more tell the noise";
    return;
  }
  change.p = welch_log_p(before, after);
  if (least_rank_sum_p(before.size(), after.size()) > alpha) {
    change.is_rank_significant = false;
    change.reason =
        fmt::format("{} and {} repetitions cannot show a change at alpha {:g}; {} of each can",
                    before.size(), after.size(), alpha, fewest_repetitions(alpha));
    return;
  }
  change.is_rank_significant = rank_sum_p(before, after) <= alpha;
}

void test_scores(const ComparedRuns& runs, const RowPair& pair, const Quantity& quantity,
                 Change& change) {
  const auto seeds = paired_seeds(runs.before.samples(pair.before_index, quantity),
                                  runs.after.samples(pair.after_index, quantity),
                                  is_sequence_metric(quantity.name));
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
  if (!uses_seed(runs.after.run(), pair.after->method)) {
    change.p = 0.0;
    change.reason = "no random numbers";
  } else if (seeds.size() >= 2) {
    change.p = paired_t_p(differences);
  } else {
    change.reason = "one seed in common; two or more tell the noise of the estimator";
  }
}

bool has_status(const SummaryRow& row, Status status) {
  return std::any_of(row.statuses.begin(), row.statuses.end(),
                     [&](const auto& entry) { return entry.first == status; });
}

/// Failures and skips: a verdict if one of the rows has no result.
std::optional<Change> failure(const RowPair& pair) {
  const auto has_result = [](const SummaryRow& row) {
    return !row.has_failure() && row.total_s.has_value();
  };
  const bool was = has_result(*pair.before);
  const bool is = has_result(*pair.after);
  if (was && is) return std::nullopt;
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
    // What is refused now was measured once, by the same method on the same machine.
    const bool is_lost = pair.after->has_failure() || has_status(*pair.after, Status::unsupported);
    change.verdict = is_lost ? Verdict::worse : Verdict::not_measured;
  }
  change.reason = statuses;
  return change;
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

Change empty_change(const RowPair& pair, const Quantity& quantity) {
  Change change;
  change.scene = pair.any().scene;
  change.method = pair.any().method;
  change.budget = pair.any().budget;
  change.quantity = quantity.text;
  change.unit = quantity.unit;
  return change;
}

std::optional<Change> obstacle(const ComparedRuns& runs, const RowPair& pair) {
  Change change = empty_change(pair, time_quantity("total_s", false));
  change.verdict = Verdict::not_measured;
  if (pair.before == nullptr || pair.after == nullptr) {
    change.reason = pair.before == nullptr ? "only in the later run" : "only in the earlier run";
    return change;
  }
  if (std::optional<Change> failed = failure(pair)) return failed;
  const CellRecord* before = first_record(runs.before.run(), *pair.before);
  const CellRecord* after = first_record(runs.after.run(), *pair.after);
  if (before == nullptr || after == nullptr) {
    change.reason = before == nullptr ? "no record in the earlier run" : "no record yet";
    return change;
  }
  change.reason = difference_of_pictures(before->render, after->render);
  if (change.reason.empty()) return std::nullopt;
  change.verdict = Verdict::invalid;
  return change;
}

std::optional<double> canary_of(const Run& run, const SummaryRow& row) {
  std::vector<double> times;
  for (const std::size_t record : row.records) {
    if (const auto& canary_s = run.cells[record].canary_s) times.push_back(*canary_s);
  }
  if (times.empty()) return std::nullopt;
  return base::median(times);
}

std::optional<Change> time_change(const ComparedRuns& runs, const RowPair& pair,
                                  const Quantity& quantity, double alpha) {
  const std::vector<double> before =
      values_over_frames(runs.before.samples(pair.before_index, quantity));
  std::vector<double> after = values_over_frames(runs.after.samples(pair.after_index, quantity));
  const auto is_positive = [](double value) { return value > 0.0; };
  if (before.empty() || after.empty() || !std::ranges::all_of(before, is_positive) ||
      !std::ranges::all_of(after, is_positive)) {
    return std::nullopt;
  }
  Change change = empty_change(pair, quantity);
  change.before = runs.before.estimate(pair.before_index, quantity);
  change.after = runs.after.estimate(pair.after_index, quantity);
  const std::optional<double> canary_before = canary_of(runs.before.run(), *pair.before);
  const std::optional<double> canary_after = canary_of(runs.after.run(), *pair.after);
  if (canary_before && canary_after) change.machine_ratio = *canary_after / *canary_before;
  if (runs.is_by_canary) {
    if (!change.machine_ratio) {
      change.verdict = Verdict::invalid;
      change.reason = "a run was made by a version that had no canary";
      return change;
    }
    const double factor = 1.0 / *std::exchange(change.machine_ratio, std::nullopt);
    for (double& value : after) value *= factor;
    for (double* value : {&change.after->value, &change.after->low, &change.after->high}) {
      *value *= factor;
    }
  }
  change.ratio = ratio_of_medians(before, after);
  const std::string why_not = difference_of_machines(*first_record(runs.before.run(), *pair.before),
                                                     *first_record(runs.after.run(), *pair.after));
  if (!why_not.empty()) {
    change.verdict = Verdict::invalid;
    change.reason = why_not;
  } else {
    test_times(before, after, alpha, change);
  }
  return change;
}

std::optional<Change> score_change(const ComparedRuns& runs, const RowPair& pair,
                                   const Quantity& quantity) {
  Change change = empty_change(pair, quantity);
  if (const metrics::MetricDescription* info = metric_info_of(quantity.name)) {
    change.unit = info->unit;
    if (info->better == metrics::Better::higher) change.better = Direction::higher;
  }
  change.before = runs.before.estimate(pair.before_index, quantity);
  change.after = runs.after.estimate(pair.after_index, quantity);
  if (!change.before && !change.after) return std::nullopt;
  if (!change.before || !change.after) {
    // Not a number, or of a picture identical to its reference: no ratio, and no silence about it.
    change.verdict = Verdict::not_measured;
    change.reason =
        fmt::format("no finite score in the {} run", change.before ? "later" : "earlier");
    return change;
  }
  change.reason = difference_of_scores(first_score(runs.before.run(), *pair.before, quantity),
                                       first_score(runs.after.run(), *pair.after, quantity));
  if (!change.reason.empty()) {
    change.verdict = Verdict::invalid;
    return change;
  }
  test_scores(runs, pair, quantity, change);
  return change;
}

void adjust_for_false_discovery(std::vector<Change>& changes) {
  std::vector<double> p;
  for (const Change& change : changes) {
    if (change.p) p.push_back(*change.p);
  }
  const std::vector<double> q = adjusted_for_false_discovery(p);
  std::size_t next = 0;
  for (Change& change : changes) {
    if (change.p) change.q = q[next++];
  }
}

void judge(Change& change, double alpha, double effect) {
  if (change.verdict != Verdict::inconclusive) return;
  const bool is_greater = change.after->value > change.before->value;
  const bool is_worse = is_greater == (change.better != Direction::higher);
  // Without a ratio one of the scores is not above 0: any change is beyond a share of that.
  const double ratio = change.ratio ? change.ratio->value : 0.0;
  const bool is_large = ratio <= 0.0 || std::max(ratio, 1.0 / ratio) >= 1.0 + effect;
  const bool is_significant = change.q && *change.q <= alpha && change.is_rank_significant;
  // A machine that slowed down as well explains a change if nothing of note is left without it.
  const double rest = change.machine_ratio ? ratio / *change.machine_ratio : ratio;
  const bool is_drift =
      change.machine_ratio && rest > 0.0 && is_large && std::max(rest, 1.0 / rest) < 1.0 + effect;
  if (is_significant && is_large && is_drift) {
    change.reason = fmt::format("the machine itself was {:.0f} % {} here; --canary takes that out",
                                100.0 * std::fabs(*change.machine_ratio - 1.0),
                                is_greater ? "slower" : "faster");
    return;
  }
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

}  // namespace results::comparison
