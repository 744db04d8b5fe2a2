#include "results/gates/gate_check.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "results/comparison/comparison_output.h"

namespace results::gates {

namespace {

using comparison::Change;
using comparison::ComparedRuns;
using comparison::RowPair;
using comparison::Verdict;
using nlohmann::ordered_json;

constexpr std::array kOutcomes{Outcome::failed, Outcome::inconclusive, Outcome::not_measured,
                               Outcome::passed};

constexpr const char* kNoBaseline = "no baseline";

bool concerns(const Gate& gate, const SummaryRow& row) {
  return names(gate.scenes, row.scene) && names(gate.methods, row.method);
}

class GateChecker {
 public:
  GateChecker(const std::vector<Gate>& gates, const RunValues* baseline, const RunValues& run,
              const std::string& why_none)
      : baseline_(baseline), run_(run), why_none_(why_none) {
    report_.gates = gates;
  }

  GateReport check() {
    for (std::size_t i = 0; i < report_.gates.size(); ++i) check_gate(i);
    judge_changes();
    const bool lacks_baseline = std::ranges::any_of(
        report_.entries, [](const GateEntry& entry) { return entry.change.reason == kNoBaseline; });
    if (lacks_baseline) report_.notes.push_back(why_none_);
    return std::move(report_);
  }

 private:
  void check_gate(std::size_t index) {
    const Gate& gate = report_.gates[index];
    const std::optional<Quantity> quantity =
        gate.is_each_stage ? std::nullopt : find_quantity(gate);
    if (gate.at_most || gate.at_least) check_limits(index, quantity);
    if (!gate.needs_baseline()) return;
    if (baseline_ == nullptr) {
      for (const SummaryRow& row : run_.summary().rows) {
        if (concerns(gate, row)) add_unmeasured(index, row, kNoBaseline);
      }
      return;
    }
    for (const RowPair& pair : comparison::paired_rows(baseline_->summary(), run_.summary())) {
      // What only the baseline has may have been filtered out of this run.
      if (pair.after == nullptr || !concerns(gate, *pair.after)) continue;
      if (std::optional<Change> obstacle = comparison::obstacle({*baseline_, run_}, pair)) {
        report_.entries.push_back({index, std::move(*obstacle)});
      } else if (gate.is_each_stage) {
        check_stages(index, pair);
      } else {
        check_change(index, pair, quantity);
      }
    }
  }

  /// Every stage that takes its share of the row's time in one of the runs.
  void check_stages(std::size_t index, const RowPair& pair) {
    const Gate& gate = report_.gates[index];
    const std::vector<std::string> before = comparison::stages_of(baseline_->run(), *pair.before);
    std::vector<std::string> stages = comparison::stages_of(run_.run(), *pair.after);
    for (const std::string& name : before) {
      if (std::ranges::find(stages, name) == stages.end()) stages.push_back(name);
    }
    for (const std::string& name : stages) {
      const Quantity stage = comparison::stage_quantity(name);
      const bool is_large =
          share_of(*baseline_, *pair.before, pair.before_index, stage) >= gate.share ||
          share_of(run_, *pair.after, pair.after_index, stage) >= gate.share;
      if (is_large) check_change(index, pair, stage);
    }
  }

  /// Of the time of a row; 0 without one. Of a sequence, stages are those of the next frames.
  static double share_of(const RunValues& values, const SummaryRow& row, std::size_t index,
                         const Quantity& stage) {
    const std::optional<Estimate> part = values.estimate(index, stage);
    const std::optional<Estimate> whole = values.estimate(
        index, comparison::time_quantity(row.is_sequence ? "next_frame_s" : "total_s", false));
    if (!part || !whole || whole->value <= 0.0) return 0.0;
    return part->value / whole->value;
  }

  /// Nothing if no row of the run has it: its only rows failed.
  std::optional<Quantity> find_quantity(const Gate& gate) {
    try {
      return run_.find_quantity(gate.quantity, gate.place);
    } catch (const base::InputError& error) {
      report_.notes.emplace_back(error.what());
      return std::nullopt;
    }
  }

  void add_unmeasured(std::size_t index, const SummaryRow& row, const std::string& reason) {
    add_unmeasured(index, row, report_.gates[index].quantity, reason);
  }

  void add_unmeasured(std::size_t index, const SummaryRow& row, const std::string& quantity,
                      const std::string& reason) {
    Change change;
    change.scene = row.scene;
    change.method = row.method;
    change.budget = row.budget;
    change.quantity = quantity;
    change.verdict = Verdict::not_measured;
    change.reason = reason;
    report_.entries.push_back({index, std::move(change)});
  }

  void check_change(std::size_t index, const RowPair& pair,
                    const std::optional<Quantity>& quantity) {
    const Gate& gate = report_.gates[index];
    const ComparedRuns runs{*baseline_, run_};
    std::optional<Change> change;
    if (quantity) {
      change = gate.is_score ? comparison::score_change(runs, pair, *quantity)
                             : comparison::time_change(runs, pair, *quantity, gate.alpha);
    }
    if (!change) {
      const std::string& name = quantity ? quantity->text : gate.quantity;
      add_unmeasured(index, *pair.after, name, fmt::format("no {} in one of the runs", name));
      return;
    }
    report_.entries.push_back({index, std::move(*change)});
  }

  void check_limits(std::size_t index, const std::optional<Quantity>& quantity) {
    const Gate& gate = report_.gates[index];
    const auto& rows = run_.summary().rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!concerns(gate, rows[i])) continue;
      const std::optional<Estimate> value =
          quantity ? run_.estimate(i, *quantity) : std::optional<Estimate>();
      if (!value) {
        add_unmeasured(index, rows[i], fmt::format("no {}", gate.quantity));
        continue;
      }
      Change change;
      change.scene = rows[i].scene;
      change.method = rows[i].method;
      change.budget = rows[i].budget;
      change.quantity = quantity->text;
      change.unit = quantity->unit;
      change.after = value;
      judge_limits(gate, change);
      report_.entries.push_back({index, std::move(change)});
    }
  }

  static void judge_limits(const Gate& gate, Change& change) {
    const Estimate& value = *change.after;
    const bool is_beyond = (gate.at_most && value.low > *gate.at_most) ||
                           (gate.at_least && value.high < *gate.at_least);
    const bool is_within = (!gate.at_most || value.high <= *gate.at_most) &&
                           (!gate.at_least || value.low >= *gate.at_least);
    change.verdict = is_beyond ? Verdict::worse : is_within ? Verdict::same : Verdict::inconclusive;
    if (change.verdict == Verdict::inconclusive) {
      change.reason = fmt::format("its interval, {:.4g} to {:.4g}, reaches across the limit",
                                  value.low, value.high);
    }
    if (change.verdict == Verdict::worse) change.reason = "beyond the limit: " + gate.text;
  }

  /// All changes of all gates are one family of tests.
  void judge_changes() {
    std::vector<Change> changes;
    for (GateEntry& entry : report_.entries) changes.push_back(std::move(entry.change));
    comparison::adjust_for_false_discovery(changes);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const Gate& gate = report_.gates[report_.entries[i].gate];
      if (gate.worse_by && changes[i].before) {
        comparison::judge(changes[i], gate.alpha, *gate.worse_by);
      }
      report_.entries[i].change = std::move(changes[i]);
    }
  }

  const RunValues* baseline_;
  const RunValues& run_;
  std::string why_none_;
  GateReport report_;
};

}  // namespace

std::string to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return "passed";
    case Outcome::failed:
      return "failed";
    case Outcome::inconclusive:
      return "inconclusive";
    case Outcome::not_measured:
      break;
  }
  return "not_measured";
}

Outcome outcome_of(const comparison::Change& change) {
  switch (change.verdict) {
    case Verdict::worse:
      return Outcome::failed;
    case Verdict::better:
    case Verdict::same:
      return Outcome::passed;
    case Verdict::inconclusive:
      return Outcome::inconclusive;
    case Verdict::invalid:
    case Verdict::not_measured:
      break;
  }
  return Outcome::not_measured;
}

std::size_t GateReport::count(Outcome outcome) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      entries, [&](const GateEntry& entry) { return outcome_of(entry.change) == outcome; }));
}

Outcome GateReport::outcome(std::size_t gate) const {
  const auto has = [&](Outcome wanted) {
    return std::ranges::any_of(entries, [&](const GateEntry& entry) {
      return entry.gate == gate && outcome_of(entry.change) == wanted;
    });
  };
  for (const Outcome outcome : kOutcomes) {
    if (has(outcome)) return outcome;
  }
  return Outcome::not_measured;
}

Outcome GateReport::overall() const {
  for (const Outcome outcome : kOutcomes) {
    if (count(outcome) > 0) return outcome;
  }
  return Outcome::not_measured;
}

GateReport check_gates(const std::vector<Gate>& gates, const RunValues* baseline,
                       const RunValues& run, const std::string& why_none) {
  return GateChecker(gates, baseline, run, why_none).check();
}

Table gate_table(const GateReport& report, bool all) {
  std::vector<Change> changes;
  std::vector<std::string> texts;
  for (const GateEntry& entry : report.entries) {
    // A note says once that there is no baseline.
    const bool is_told = entry.change.reason == kNoBaseline;
    if (!all && (is_told || outcome_of(entry.change) == Outcome::passed)) continue;
    changes.push_back(entry.change);
    texts.push_back(report.gates[entry.gate].text);
  }
  Table table = comparison::table_of(changes, "quantity");
  table.columns.insert(table.columns.begin(), {"gate", "", Direction::none, false});
  for (std::size_t i = 0; i < texts.size(); ++i) {
    table.rows[i].insert(table.rows[i].begin(), TableCell{texts[i], std::nullopt, false, ""});
  }
  std::vector<std::string> counts;
  for (const Outcome outcome : kOutcomes) {
    const std::size_t count = report.count(outcome);
    if (count > 0) counts.push_back(fmt::format("{} {}", count, to_string(outcome)));
  }
  std::string line =
      counts.empty() ? "no row concerns a gate" : fmt::format("{}", fmt::join(counts, ", "));
  std::ranges::replace(line, '_', ' ');
  table.notes.push_back("gates: " + line);
  for (const std::string& note : report.notes) table.notes.push_back(note);
  return table;
}

ordered_json to_json(const GateReport& report) {
  ordered_json json{{"outcome", to_string(report.overall())},
                    {"counts", ordered_json::object()},
                    {"entries", ordered_json::array()},
                    {"notes", report.notes}};
  for (const Outcome outcome : kOutcomes)
    json["counts"][to_string(outcome)] = report.count(outcome);
  for (const GateEntry& entry : report.entries) {
    ordered_json one{{"gate", report.gates[entry.gate].text},
                     {"outcome", to_string(outcome_of(entry.change))}};
    one.update(comparison::to_json(entry.change));
    json["entries"].push_back(std::move(one));
  }
  return json;
}

}  // namespace results::gates
