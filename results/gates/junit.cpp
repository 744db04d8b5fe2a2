#include "results/gates/junit.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/markup_text.h"

namespace results::gates {

namespace {

/// XML 1.0, Sec. 2.2: below U+0020 only tab, line feed and carriage return are characters.
std::string xml(std::string_view text) {
  std::string allowed;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') {
      allowed += "\xEF\xBF\xBD";
    } else {
      allowed += c;
    }
  }
  return escape(allowed);
}

/// What stands in a test case that did not pass.
struct Mark {
  const char* element = "";  ///< error | failure | skipped
  std::string message;
};

struct Case {
  std::string group;
  std::string name;
  std::optional<double> time_s;
  std::optional<Mark> mark;
  std::string properties;
};

std::string to_xml(const Case& one) {
  std::string text =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\"", xml(one.group), xml(one.name));
  if (one.time_s && std::isfinite(*one.time_s))
    text += fmt::format(" time=\"{:.6f}\"", *one.time_s);
  if (!one.mark && one.properties.empty()) return text + "/>\n";
  text += ">\n";
  if (!one.properties.empty()) {
    text += "      <properties>\n" + one.properties + "      </properties>\n";
  }
  if (one.mark) {
    text += fmt::format("      <{} message=\"{}\"/>\n", one.mark->element, xml(one.mark->message));
  }
  return text + "    </testcase>\n";
}

/// The first reason that a record of the row gives.
std::string reason_of(const Run& run, const SummaryRow& row) {
  for (const std::size_t i : row.records) {
    const RenderRecord& render = run.cells[i].render;
    if (!is_success(render.status) && render.reason) return ": " + *render.reason;
  }
  return "";
}

Case case_of(const RunValues& values, const SummaryRow& row) {
  Case one{row.scene, fmt::format("{} {}", row.method, row.budget), std::nullopt, {}, ""};
  if (row.total_s) one.time_s = row.total_s->value;
  const std::string message = format_statuses(row) + reason_of(values.run(), row);
  if (row.has_failure()) {
    one.mark = Mark{"error", message};
  } else if (!row.total_s) {
    one.mark = Mark{"skipped", message};
  }
  for (const ScoreSummary& score : row.scores) {
    const std::optional<double> value = score.value();
    if (!value || !std::isfinite(*value)) continue;
    one.properties += fmt::format("        <property name=\"{}@{}\" value=\"{:.9g}\"/>\n",
                                  xml(score.metric), score.against, *value);
  }
  return one;
}

Case case_of(const GateReport& gates, const GateEntry& entry) {
  const comparison::Change& change = entry.change;
  const Gate& gate = gates.gates[entry.gate];
  std::string name = fmt::format("{} {}: {}", change.method, change.budget, gate.text);
  // Readers tell cases apart by their names.
  if (gate.is_each_stage) name += ": " + change.quantity;
  Case one{change.scene, std::move(name), std::nullopt, {}, ""};
  std::string message = change.reason;
  if (change.ratio) {
    message = fmt::format(
        "{} {:.6g} -> {:.6g} {} ({:+.1f} %){}{}", change.quantity,
        change.before ? change.before->value : 0.0, change.after ? change.after->value : 0.0,
        change.unit, 100.0 * (change.ratio->value - 1.0), message.empty() ? "" : ": ", message);
  }
  const Outcome outcome = outcome_of(change);
  if (outcome == Outcome::failed) one.mark = Mark{"failure", message};
  if (outcome == Outcome::inconclusive || outcome == Outcome::not_measured) {
    one.mark = Mark{"skipped", to_string(outcome) + ": " + message};
  }
  return one;
}

/// A suite of cases with the counts that readers want up front.
std::string suite_xml(const std::string& name, const std::vector<Case>& cases) {
  std::size_t errors = 0;
  std::size_t failures = 0;
  std::size_t skipped = 0;
  std::string text;
  for (const Case& one : cases) {
    const std::string_view element = one.mark ? one.mark->element : "";
    if (element == "error") ++errors;
    if (element == "failure") ++failures;
    if (element == "skipped") ++skipped;
    text += to_xml(one);
  }
  return fmt::format(
      "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\">\n{}"
      "  </testsuite>\n",
      xml(name), cases.size(), failures, errors, skipped, text);
}

}  // namespace

std::string junit_xml(const RunValues& run, const GateReport& gates) {
  const std::string suite = run.run().info->value("suite", "");
  std::vector<Case> cells;
  for (const SummaryRow& row : run.summary().rows) cells.push_back(case_of(run, row));
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  text += suite_xml(suite, cells);
  if (!gates.entries.empty()) {
    std::vector<Case> entries;
    for (const GateEntry& entry : gates.entries) entries.push_back(case_of(gates, entry));
    text += suite_xml(suite + " gates", entries);
  }
  return text + "</testsuites>\n";
}

}  // namespace results::gates
