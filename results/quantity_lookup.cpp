#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/names.h"
#include "results/record_fields.h"
#include "results/run_values.h"

namespace results {
namespace {

/// The stored spelling of a name; nothing if it is not there.
std::optional<std::string> known_name(const std::set<std::string>& names, std::string_view name) {
  for (const std::string& known : names) {
    if (base::is_same_name(known, name)) return known;
  }
  return std::nullopt;
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

/// "flip@full" -> "full", and the text without it; "own" if it says nothing.
std::string take_against(std::string_view& text) {
  for (const char* side : {"own", "full"}) {
    if (!ends_with(text, fmt::format("@{}", side))) continue;
    text.remove_suffix(std::string_view(side).size() + 1);
    return side;
  }
  return "own";
}

const char* prefix_of(Quantity::Kind kind) {
  switch (kind) {
    case Quantity::Kind::stage:
      return "stage.";
    case Quantity::Kind::counter:
      return "counter.";
    case Quantity::Kind::score:
      return "score.";
    case Quantity::Kind::parameter:
      return "parameter.";
    case Quantity::Kind::time:
      break;
  }
  return "";
}

/// Takes a prefix off; true if it was there.
bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (prefix.empty() || text.substr(0, prefix.size()) != prefix) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// What a text asks for, before it is known whether it is there.
struct QuantityText {
  std::string_view name;  ///< without prefixes
  bool is_first_frame = false;
  std::optional<Quantity::Kind> kind;  ///< if a prefix says it
};

QuantityText read_prefixes(std::string_view text) {
  QuantityText asked{text, false, std::nullopt};
  asked.is_first_frame = take_prefix(asked.name, "first.");
  for (const auto kind : {Quantity::Kind::stage, Quantity::Kind::counter, Quantity::Kind::score,
                          Quantity::Kind::parameter}) {
    if (!asked.kind && take_prefix(asked.name, prefix_of(kind))) asked.kind = kind;
  }
  return asked;
}

Quantity quantity_of(Quantity::Kind kind, std::string name, std::string unit) {
  Quantity quantity;
  quantity.kind = kind;
  quantity.name = std::move(name);
  quantity.unit = std::move(unit);
  return quantity;
}

}  // namespace

/// Texts of the run's metrics that a name stands for: the text itself, the one of that id, or all
/// without an id of that name.
std::vector<std::string> RunValues::metric_texts(std::string_view name) const {
  std::vector<std::string> texts;
  for (const std::string& text : summary_.metrics) {
    if (base::is_same_name(text, name)) return {text};
    const std::string id = metric_id_of(text);
    if (!id.empty() && base::is_same_name(id, name)) return {text};
    if (base::is_same_name(text.substr(0, text.find(',')), name)) texts.push_back(text);
  }
  return texts;
}

std::optional<Quantity> RunValues::find_score(std::string_view name,
                                              const base::Place& place) const {
  const std::string against = take_against(name);
  for (const std::size_t dot : {std::string_view::npos, name.rfind('.')}) {
    const std::string_view metric = name.substr(0, dot);
    const std::vector<std::string> texts = metric_texts(metric);
    if (texts.size() > 1) {
      throw base::InputError(place, fmt::format("\"{}\" is the name of several metrics here; write "
                                                "one of: {}",
                                                metric, fmt::join(texts, " | ")));
    }
    if (texts.empty()) continue;
    Quantity score = quantity_of(Quantity::Kind::score, texts.front(), "");
    if (dot != std::string_view::npos) score.detail = std::string(name.substr(dot + 1));
    score.against = against;
    const metrics::MetricDescription* info = metric_info_of(texts.front());
    if (info != nullptr && score.detail.empty()) score.unit = info->unit;
    return score;
  }
  return std::nullopt;
}

/// Everything that the text may mean; more than one if it is ambiguous.
std::vector<Quantity> RunValues::candidates(std::string_view text, const base::Place& place) const {
  const QuantityText asked = read_prefixes(text);
  std::vector<Quantity> found;
  if (const RecordField* field = asked.kind ? nullptr : find_record_field(asked.name)) {
    found.push_back(quantity_of(Quantity::Kind::time, field->name, field->unit));
  } else {
    if (const auto stage = known_name(stage_names_, asked.name)) {
      found.push_back(quantity_of(Quantity::Kind::stage, *stage, "s"));
    }
    const auto parameter = known_name(parameter_names_, asked.name);
    const auto counter = known_name(counter_names_, asked.name);
    if (parameter) found.push_back(quantity_of(Quantity::Kind::parameter, *parameter, ""));
    // Many counters say what a parameter asked for.
    if (counter && (!parameter || asked.kind)) {
      found.push_back(quantity_of(Quantity::Kind::counter, *counter, ""));
    }
    if (const auto score = find_score(asked.name, place)) found.push_back(*score);
  }
  if (asked.kind) {
    std::erase_if(found, [&](const Quantity& one) { return one.kind != *asked.kind; });
  }
  for (Quantity& one : found) {
    one.text = std::string(text);
    one.is_first_frame = asked.is_first_frame;
  }
  if (found.size() < 2) return found;
  std::vector<std::string> ways;
  for (const Quantity& one : found) {
    ways.push_back((asked.is_first_frame ? "first." : "") + std::string(prefix_of(one.kind)) +
                   std::string(asked.name));
  }
  throw base::InputError(place, fmt::format("\"{}\" is the name of several things here; write one "
                                            "of: {}",
                                            text, fmt::join(ways, ", ")));
}

Quantity RunValues::find_quantity(std::string_view text, const base::Place& place) const {
  const std::vector<Quantity> found = candidates(text, place);
  if (!found.empty()) return found.front();
  const QuantityText asked = read_prefixes(text);
  const auto fail = [&](const char* kind, const std::set<std::string>& known) {
    throw base::InputError(
        place,
        base::unknown_name(kind, asked.name, std::vector<std::string>(known.begin(), known.end())));
  };
  if (asked.kind == Quantity::Kind::stage) fail("stage", stage_names_);
  if (asked.kind == Quantity::Kind::counter) fail("counter", counter_names_);
  if (asked.kind == Quantity::Kind::parameter) fail("parameter", parameter_names_);
  if (asked.kind == Quantity::Kind::score) {
    throw base::InputError(place, base::unknown_name("metric", asked.name, summary_.metrics));
  }
  throw base::InputError(place, base::unknown_name("quantity", text, quantity_names()));
}

void RunValues::check_quantity(std::string_view text, const base::Place& place) const {
  if (!candidates(text, place).empty()) return;
  const QuantityText asked = read_prefixes(text);
  const std::string metric(asked.name.substr(0, asked.name.find_first_of(".,@")));
  const bool is_of_metric =
      metric_info_of(metric) != nullptr || asked.name.find('@') != std::string_view::npos;
  if (asked.kind == Quantity::Kind::score || (!asked.kind && is_of_metric)) {
    throw base::InputError(place, base::unknown_name("metric", metric, summary_.metrics));
  }
  if (asked.kind == Quantity::Kind::parameter) {
    const std::vector<std::string> known(parameter_names_.begin(), parameter_names_.end());
    throw base::InputError(place, base::unknown_name("parameter", asked.name, known));
  }
}

void RunValues::collect_names() {
  for (const CellRecord& record : run_.cells) {
    for (const renderers::StageRecord& stage : record.render.stages) {
      stage_names_.insert(stage.path);
    }
    for (const auto& [name, value] : record.render.counters) counter_names_.insert(name);
  }
  for (const RowFacts& row : rows_) {
    for (const ParameterValues* values : {&row.sweep, &row.settings}) {
      for (const auto& [name, value] : *values) {
        if (number_of(value)) parameter_names_.insert(name);
      }
    }
  }
}

std::vector<std::string> RunValues::quantity_names() const {
  std::vector<std::string> names;
  for (const RecordField& field : record_fields()) names.emplace_back(field.name);
  for (const auto* some : {&stage_names_, &counter_names_, &parameter_names_}) {
    names.insert(names.end(), some->begin(), some->end());
  }
  names.insert(names.end(), summary_.metrics.begin(), summary_.metrics.end());
  return names;
}

}  // namespace results
