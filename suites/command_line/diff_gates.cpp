#include "suites/command_line/diff_gates.h"

#include <algorithm>

#include <fmt/format.h>

#include "perception/base/document.h"
#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace suites::command_line {

namespace {

/// The metric and the detail of "flip", "flip.p95", "relmse,trim=0.001" or "relmse,trim=0.001.max".
void split_name(const std::string& name, const std::vector<metrics::AnyMetricChoice>& choices,
                DiffGate& gate) {
  std::vector<std::string> known;
  for (const metrics::AnyMetricChoice& choice : choices) {
    for (const std::string& key : {text_of(choice), description_of(choice).name}) {
      if (name == key) gate.metric = key;
      if (name.rfind(key + ".", 0) == 0 && gate.metric.empty()) {
        gate.metric = key;
        gate.detail = name.substr(key.size() + 1);
      }
    }
    known.push_back(text_of(choice));
  }
  if (gate.metric == name) gate.detail.clear();
  if (gate.metric.empty()) {
    const std::string option = gate.is_upper ? "--fail-above" : "--fail-below";
    throw base::InputError({option}, base::unknown_name("metric of this diff", name, known));
  }
}

DiffGate parse_gate(const std::string& text, bool is_upper,
                    const std::vector<metrics::AnyMetricChoice>& choices) {
  const std::string option = is_upper ? "--fail-above" : "--fail-below";
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw base::InputError({option},
                           fmt::format("\"{}\" is not a limit; accepted: METRIC=V, such as "
                                       "flip=0.1",
                                       text));
  }
  DiffGate gate;
  gate.text = text;
  gate.is_upper = is_upper;
  gate.limit = base::Node::from_plain_scalar(text.substr(equals + 1), {option})
                   .number("the limit of " + text.substr(0, equals));
  split_name(text.substr(0, equals), choices, gate);
  return gate;
}

/// A limit on the wrong side lets bad images pass and stops good ones.
void check_direction(const DiffGate& gate, const std::vector<metrics::AnyMetricChoice>& choices) {
  for (const metrics::AnyMetricChoice& choice : choices) {
    const metrics::MetricDescription& info = description_of(choice);
    const bool wants_upper = info.better == metrics::Better::lower;
    if (!concerns(gate, choice) || !gate.detail.empty() || wants_upper == gate.is_upper) continue;
    throw base::InputError(
        {gate.is_upper ? "--fail-above" : "--fail-below"},
        fmt::format("{} is better when {}; use {} {}", info.name, wants_upper ? "lower" : "higher",
                    wants_upper ? "--fail-above" : "--fail-below", gate.text));
  }
}

}  // namespace

std::vector<DiffGate> parse_gates(const std::vector<std::string>& above,
                                  const std::vector<std::string>& below,
                                  const std::vector<metrics::AnyMetricChoice>& choices) {
  std::vector<DiffGate> gates;
  for (const std::string& text : above) gates.push_back(parse_gate(text, true, choices));
  for (const std::string& text : below) gates.push_back(parse_gate(text, false, choices));
  for (const DiffGate& gate : gates) check_direction(gate, choices);
  return gates;
}

bool concerns(const DiffGate& gate, const metrics::AnyMetricChoice& choice) {
  return gate.metric == text_of(choice) || gate.metric == description_of(choice).name;
}

bool is_violated(const DiffGate& gate, const metrics::Score& score) {
  double value = score.value;
  if (!gate.detail.empty()) {
    std::vector<std::string> known;
    for (const metrics::NamedValue& detail : score.details) known.push_back(detail.name);
    const auto found = std::find_if(known.begin(), known.end(), [&gate](const std::string& name) {
      return base::is_same_name(name, gate.detail);
    });
    if (found == known.end()) {
      throw base::InputError({gate.text},
                             base::unknown_name("detail of " + gate.metric, gate.detail, known));
    }
    value = score.details[static_cast<std::size_t>(found - known.begin())].value;
  }
  return gate.is_upper ? value > gate.limit : value < gate.limit;
}

}  // namespace suites::command_line
