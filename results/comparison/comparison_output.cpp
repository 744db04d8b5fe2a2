#include "results/comparison/comparison_output.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "perception/base/units.h"

namespace results::comparison {

namespace {

using nlohmann::ordered_json;

constexpr Verdict kVerdicts[] = {Verdict::worse,        Verdict::better,  Verdict::same,
                                 Verdict::inconclusive, Verdict::invalid, Verdict::not_measured};

TableCell words(std::string text) { return {std::move(text), std::nullopt, false, ""}; }

std::string format_value(const Change& change, const std::optional<Estimate>& value) {
  if (!value) return "-";
  return change.unit == "s" ? format_time(*value) : format_score(*value);
}

/// "+12.3 %", with more digits for less.
std::string format_percent(double ratio) {
  const double percent = 100.0 * (ratio - 1.0);
  return fmt::format("{:+.{}f} %", percent, std::fabs(percent) < 9.95 ? 1 : 0);
}

std::string format_ratio(const std::optional<Estimate>& ratio) {
  if (!ratio) return "-";
  if (ratio->low == ratio->high) return format_percent(ratio->value);
  return fmt::format("{} [{}, {}]", format_percent(ratio->value), format_percent(ratio->low),
                     format_percent(ratio->high));
}

std::string format_p(const std::optional<double>& p) {
  if (!p) return "-";
  return *p < 1e-4 ? "< 0.0001" : fmt::format("{:.2g}", *p);
}

Table empty_table(std::initializer_list<const char*> titles) {
  Table table;
  for (const char* title : titles) table.columns.push_back({title, "", Direction::none, false});
  return table;
}

std::vector<TableCell> row_of(const Change& change) {
  return {words(format_verdict(change.verdict)),
          words(change.scene),
          words(change.method),
          words(change.budget),
          words(change.quantity),
          words(format_value(change, change.before)),
          words(format_value(change, change.after)),
          words(format_ratio(change.ratio)),
          words(format_p(change.q)),
          words(change.reason)};
}

bool is_noteworthy(Verdict verdict) {
  return verdict == Verdict::worse || verdict == Verdict::better || verdict == Verdict::invalid;
}

ordered_json estimate_json(const std::optional<Estimate>& estimate) {
  if (!estimate) return nullptr;
  return {{"value", estimate->value},
          {"low", estimate->low},
          {"high", estimate->high},
          {"count", estimate->count}};
}

ordered_json number_json(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

}  // namespace

std::string format_verdict(Verdict verdict) {
  switch (verdict) {
    case Verdict::worse:
      return "- worse";
    case Verdict::better:
      return "+ better";
    case Verdict::same:
      return "= same";
    case Verdict::inconclusive:
      return "? inconclusive";
    case Verdict::invalid:
      return "x invalid";
    case Verdict::not_measured:
      break;
  }
  return ". not measured";
}

Table table_of(const std::vector<Change>& changes, const char* quantity_title) {
  Table table = empty_table({"verdict", "scene", "method", "budget", quantity_title, "before",
                             "after", "change", "q", "reason"});
  for (const Change& change : changes) table.rows.push_back(row_of(change));
  return table;
}

Table change_table(const Comparison& comparison, bool only_changed) {
  std::vector<Change> shown;
  for (const Change& change : comparison.changes) {
    if (!only_changed || is_noteworthy(change.verdict)) shown.push_back(change);
  }
  Table table = table_of(shown, "quantity");
  table.notes.push_back(format_counts(comparison));
  table.notes.emplace_back(
      "change: after over before, [ ] its 95 % interval; q: share of false alarms among changes "
      "that are at least as clear");
  for (const std::string& note : comparison.notes) table.notes.push_back(note);
  return table;
}

Table stage_table(const Comparison& comparison) {
  Table table = table_of(comparison.stages, "stage");
  table.notes.emplace_back("stages of rows whose time changed, those that moved most first");
  return table;
}

Table overall_table(const Comparison& comparison) {
  Table table = empty_table({"method", "budget", "quantity", "change", "scenes"});
  for (const Overall& overall : comparison.overall) {
    table.rows.push_back({words(overall.method), words(overall.budget), words(overall.quantity),
                          words(format_ratio(overall.ratio)),
                          words(std::to_string(overall.ratio.count))});
  }
  table.notes.emplace_back("geometric means over scenes, [ ] their 95 % intervals");
  return table;
}

std::string format_counts(const Comparison& comparison) {
  std::vector<std::string> counts;
  for (const Verdict verdict : kVerdicts) {
    const std::size_t count = comparison.count(verdict);
    if (count > 0) counts.push_back(fmt::format("{} {}", count, to_string(verdict)));
  }
  std::string text =
      counts.empty() ? "nothing to compare" : fmt::format("{}", fmt::join(counts, ", "));
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

ordered_json to_json(const Change& change) {
  return {{"scene", change.scene},
          {"method", change.method},
          {"budget", change.budget},
          {"quantity", change.quantity},
          {"unit", change.unit},
          {"better", change.better == Direction::higher ? "higher" : "lower"},
          {"before", estimate_json(change.before)},
          {"after", estimate_json(change.after)},
          {"ratio", estimate_json(change.ratio)},
          {"p", number_json(change.p)},
          {"q", number_json(change.q)},
          {"verdict", to_string(change.verdict)},
          {"reason", change.reason}};
}

ordered_json to_json(const Comparison& comparison) {
  ordered_json counts = ordered_json::object();
  for (const Verdict verdict : kVerdicts) counts[to_string(verdict)] = comparison.count(verdict);
  ordered_json json{{"counts", std::move(counts)},
                    {"changes", ordered_json::array()},
                    {"stages", ordered_json::array()},
                    {"overall", ordered_json::array()},
                    {"notes", comparison.notes}};
  for (const Change& change : comparison.changes) json["changes"].push_back(to_json(change));
  for (const Change& stage : comparison.stages) json["stages"].push_back(to_json(stage));
  for (const Overall& overall : comparison.overall) {
    json["overall"].push_back({{"method", overall.method},
                               {"budget", overall.budget},
                               {"quantity", overall.quantity},
                               {"ratio", estimate_json(overall.ratio)}});
  }
  return json;
}

}  // namespace results::comparison
