#include "results/gates/gate.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/units.h"

namespace results::gates {

using nlohmann::ordered_json;

namespace {

constexpr double kMostChange = 100.0;  // a hundredfold
constexpr double kMostAlpha = 0.5;
constexpr const char* kEachStage = "each";

double read_share(const base::Node& node, const char* what, double most) {
  const double share = base::parse_percent(node.scalar_text(what), node.place());
  if (share > 0.0 && share <= most) return share;
  throw base::InputError(node.place(),
                         fmt::format("{} is \"{}\"; accepted: more than 0% and up to {:g}%", what,
                                     node.scalar_text(what), 100.0 * most));
}

std::vector<std::string> read_ids(base::MapReader& reader, const char* key) {
  std::vector<std::string> ids;
  const base::Node* node = reader.find(key);
  if (node == nullptr) return ids;
  for (const base::Node& id : node->list(key)) ids.push_back(id.text(key));
  if (ids.empty()) {
    throw base::InputError(node->place(),
                           fmt::format("{} is an empty list; accepted: ids, or no {}", key, key));
  }
  return ids;
}

/// A stage as quantities are named: "total" is total_s, other names are stages.
std::string quantity_of_stage(const std::string& stage) {
  for (const char* time : {"total", "next_frame", "new_view"}) {
    if (stage == time) return fmt::format("{}_s", time);
  }
  return "stage." + stage;
}

double read_limit(const base::Node& node, const char* what, bool is_time) {
  return is_time ? base::parse_duration_s(node.scalar_text(what), node.place()) : node.number(what);
}

/// "flip@full worse by 5%, at most 0.2"
std::string text_of(const Gate& gate, const std::string& name) {
  std::string text = name;
  const char* unit = gate.is_score ? "" : " s";
  const char* separator = " ";
  if (gate.worse_by) {
    text += fmt::format(" {} by {:g}%", gate.is_score ? "worse" : "slower", 100.0 * *gate.worse_by);
    separator = ", ";
  }
  if (gate.at_most) {
    text += fmt::format("{}at most {:g}{}", separator, *gate.at_most, unit);
    separator = ", ";
  }
  if (gate.at_least) text += fmt::format("{}at least {:g}{}", separator, *gate.at_least, unit);
  return text;
}

/// `stage: each` is a change of many quantities; a limit is one of a single quantity.
void read_each_stage(base::MapReader& reader, const base::Node& stage, Gate& gate) {
  if (const base::Node* share = reader.find("share")) gate.share = read_share(*share, "share", 1.0);
  gate.is_each_stage = true;
  if (reader.find("at_most") != nullptr || reader.find("slower_by") == nullptr) {
    throw base::InputError(stage.place(),
                           "stage: each needs slower_by and takes no at_most; limits are of a "
                           "stage that is named");
  }
}

void read_metric(base::MapReader& reader, const base::Node& metric, Gate& gate) {
  gate.is_score = true;
  gate.place = metric.place();
  gate.quantity = metric.text("metric");
  const std::string against = reader.text("against", "own");
  if (against != "own" && against != "full") {
    throw base::InputError(reader.find("against")->place(),
                           fmt::format("against is \"{}\"; accepted: own, full", against));
  }
  if (against == "full") gate.quantity += "@full";
}

Gate read_gate(const base::Node& node) {
  base::MapReader reader(node, "gate");
  Gate gate;
  const base::Node* metric = reader.find("metric");
  const base::Node* stage = reader.find("stage");
  if ((metric == nullptr) == (stage == nullptr)) {
    throw base::InputError(node.place(),
                           "a gate has either metric, the name of a score, or stage: total, "
                           "next_frame, new_view, each or the name of a stage");
  }
  std::string name;
  if (metric != nullptr) {
    read_metric(reader, *metric, gate);
    name = gate.quantity;
  } else {
    gate.place = stage->place();
    name = stage->text("stage");
    gate.quantity = quantity_of_stage(name);
    if (name == kEachStage) read_each_stage(reader, *stage, gate);
  }
  const char* change = metric != nullptr ? "worse_by" : "slower_by";
  if (const base::Node* share = reader.find(change))
    gate.worse_by = read_share(*share, change, kMostChange);
  if (const base::Node* alpha = reader.find("alpha"))
    gate.alpha = read_share(*alpha, "alpha", kMostAlpha);
  if (const base::Node* limit = reader.find("at_most")) {
    gate.at_most = read_limit(*limit, "at_most", !gate.is_score);
  }
  if (metric != nullptr) {
    if (const base::Node* limit = reader.find("at_least")) {
      gate.at_least = limit->number("at_least");
    }
  }
  gate.scenes = read_ids(reader, "scenes");
  gate.methods = read_ids(reader, "methods");
  reader.finish();
  if (!gate.worse_by && !gate.at_most && !gate.at_least) {
    throw base::InputError(node.place(), fmt::format("a gate needs a limit: {}, at_most{}", change,
                                                     metric != nullptr ? ", at_least" : ""));
  }
  gate.text = text_of(gate, gate.is_each_stage ? "each stage" : name);
  return gate;
}

}  // namespace

std::vector<Gate> read_gates(const base::Node& list) {
  std::vector<Gate> gates;
  for (const base::Node& node : list.list("gates")) gates.push_back(read_gate(node));
  return gates;
}

ordered_json to_json(const std::vector<Gate>& gates) {
  ordered_json list = ordered_json::array();
  for (const Gate& gate : gates) {
    ordered_json json;
    std::string name = gate.quantity;
    if (gate.is_score) {
      const bool is_full = name.ends_with("@full");
      if (is_full) name.resize(name.size() - std::string_view("@full").size());
      json["metric"] = name;
      json["against"] = is_full ? "full" : "own";
    } else {
      json["stage"] = name.starts_with("stage.") ? name.substr(6) : name.substr(0, name.size() - 2);
    }
    if (gate.is_each_stage) json["share"] = fmt::format("{:.15g}%", 100.0 * gate.share);
    if (gate.worse_by) {
      json[gate.is_score ? "worse_by" : "slower_by"] =
          fmt::format("{:.15g}%", 100.0 * *gate.worse_by);
    }
    json["alpha"] = fmt::format("{:.15g}%", 100.0 * gate.alpha);
    if (gate.at_most && gate.is_score) json["at_most"] = *gate.at_most;
    if (gate.at_most && !gate.is_score) json["at_most"] = fmt::format("{:.15g}s", *gate.at_most);
    if (gate.at_least) json["at_least"] = *gate.at_least;
    if (!gate.scenes.empty()) json["scenes"] = gate.scenes;
    if (!gate.methods.empty()) json["methods"] = gate.methods;
    list.push_back(std::move(json));
  }
  return list;
}

bool names(const std::vector<std::string>& ids, const std::string& id) {
  if (ids.empty()) return true;
  const std::string base = id.substr(0, id.find('['));
  return std::ranges::any_of(ids, [&](const std::string& one) { return one == id || one == base; });
}

}  // namespace results::gates
