#include "suites/suite_methods.h"

#include <algorithm>
#include <set>
#include <variant>

#include <fmt/format.h>

#include "perception/base/names.h"
#include "suites/parameter_grid.h"
#include "suites/safe_name.h"

namespace suites {
namespace {

std::vector<const base::Node*> one_or_many(const base::Node& node) {
  std::vector<const base::Node*> values;
  if (!node.is_list()) return {&node};
  for (const base::Node& value : node.list("values")) values.push_back(&value);
  return values;
}

Budget samples_budget(const base::Node& node) {
  const std::int64_t samples = node.integer("samples");
  if (samples < 1) {
    throw base::InputError(node.place(),
                           fmt::format("samples is {}; accepted: 1 or more", samples));
  }
  Budget budget;
  budget.samples = samples;
  return budget;
}

Budget time_budget(const base::Node& node) {
  Budget budget;
  budget.time_s = base::parse_duration_s(node.scalar_text("time"), node.place());
  return budget;
}

void append_budgets(const base::Node& node, std::vector<Budget>& budgets) {
  if (node.kind() == base::Node::Kind::text && node.text("budget") == "fixed") {
    budgets.emplace_back();
    return;
  }
  if (!node.is_map()) {
    throw base::InputError(node.place(),
                           fmt::format("a budget must be {{samples: N}}, {{time: 10s}} or fixed; "
                                       "found {}",
                                       base::Node::kind_name(node.kind())));
  }
  base::MapReader reader(node, "budget");
  const base::Node* samples = reader.find("samples");
  const base::Node* time = reader.find("time");
  if (reader.find("error") != nullptr) {
    throw base::InputError(node.key_place("error"),
                           "budgets by error are not supported by this version; accepted: "
                           "samples, time, fixed");
  }
  reader.finish();
  if ((samples == nullptr) == (time == nullptr)) {
    throw base::InputError(node.place(), "a budget needs exactly one of: samples, time");
  }
  for (const base::Node* value : one_or_many(samples != nullptr ? *samples : *time)) {
    budgets.push_back(samples != nullptr ? samples_budget(*value) : time_budget(*value));
  }
}

/// A method's entry, before its grid is expanded.
struct MethodEntry {
  std::string id;
  base::Place place;
  const renderers::RendererInfo* info = nullptr;
  const base::Preset* preset = nullptr;
  std::vector<base::ParameterSetting> settings;
  std::vector<Budget> budgets;
};

/// A method of a renderer without a progressive unit has nothing to count or to stop.
void check_budgets(const MethodEntry& entry, const base::Node& node) {
  const bool is_counted = std::any_of(entry.budgets.begin(), entry.budgets.end(),
                                      [](const Budget& budget) { return budget != Budget{}; });
  if (entry.info->progressive_unit || !is_counted) return;
  throw base::InputError(
      node.place(), fmt::format("renderer \"{}\" has no progressive unit and runs once; accepted "
                                "budget: fixed",
                                entry.info->name));
}

MethodEntry read_entry(base::MapReader& reader) {
  MethodEntry entry;
  entry.id = read_safe_name(reader.require("id"), "id");
  entry.place = reader.node().place();
  const base::Node& renderer = reader.require("renderer");
  entry.info = &renderers::find_renderer(renderer.text("renderer"), renderer.place());
  const base::Node* preset = reader.find("preset");
  entry.preset =
      &renderers::find_preset(*entry.info, preset == nullptr ? "best" : preset->text("preset"),
                              preset == nullptr ? entry.place : preset->place());
  if (const base::Node* parameters = reader.find("parameters")) {
    base::MapReader values(*parameters, "parameters");
    for (const auto& [key, value] : parameters->entries()) {
      entry.settings.push_back({base::snake_case(key), value});
    }
  }
  if (const base::Node* budgets = reader.find("budgets")) {
    entry.budgets = read_budgets(*budgets);
    check_budgets(entry, *budgets);
  }
  return entry;
}

/// `samples` set by hand has no effect where every budget sets it, too.
void check_samples(const SuiteMethod& method, const std::vector<base::ParameterSetting>& settings,
                   const std::vector<Budget>& suite_budgets) {
  const auto setting = std::find_if(settings.begin(), settings.end(),
                                    [](const auto& s) { return s.name == "samples"; });
  if (setting == settings.end() || !method.choice.info->progressive_unit) return;
  const std::vector<Budget> budgets = budgets_in_force(method, suite_budgets);
  if (std::find(budgets.begin(), budgets.end(), Budget{}) != budgets.end()) return;
  throw base::InputError(setting->value.place(),
                         fmt::format("samples of method \"{}\" is set by its budgets; leave it out "
                                     "here, or write budgets: [fixed]",
                                     method.id));
}

SuiteMethod method_at(const MethodEntry& entry, const GridPoint& point) {
  std::vector<base::ParameterSetting> settings = entry.settings;
  for (const auto& [name, value] : point) {
    for (const base::ParameterSetting& setting : entry.settings) {
      if (setting.name != name) continue;
      throw base::InputError(value.place(),
                             fmt::format("{} of method \"{}\" is set by parameters and swept, too; "
                                         "keep one",
                                         name, entry.id));
    }
    settings.push_back({name, value});
  }
  SuiteMethod method;
  method.base_id = entry.id;
  method.choice.info = entry.info;
  method.choice.preset = entry.preset->name;
  method.choice.parameters = base::resolve_parameters(
      entry.info->parameters, entry.preset, settings,
      fmt::format("renderer \"{}\" (method \"{}\")", entry.info->name, entry.id));
  method.budgets = entry.budgets;
  for (const auto& [name, node] : point) {
    for (const auto& [known, value] : method.choice.parameters.entries()) {
      if (base::is_same_name(known, name)) method.sweep.emplace_back(known, value);
    }
  }
  method.id = entry.id;
  for (std::size_t i = 0; i < method.sweep.size(); ++i) {
    method.id += fmt::format("{}{}={}", i == 0 ? "[" : ",", method.sweep[i].first,
                             value_text(method.sweep[i].second));
  }
  if (!method.sweep.empty()) method.id += "]";
  return method;
}

}  // namespace

std::vector<Budget> read_budgets(const base::Node& node) {
  std::vector<Budget> budgets;
  for (const base::Node& item : node.list("budgets")) {
    const std::size_t before = budgets.size();
    append_budgets(item, budgets);
    for (std::size_t i = before; i < budgets.size(); ++i) {
      const auto end = budgets.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(budgets.begin(), end, budgets[i]) != end) {
        throw base::InputError(item.place(),
                               fmt::format("budget {} is listed twice", budgets[i].name()));
      }
    }
  }
  if (budgets.empty()) {
    throw base::InputError(node.place(), "budgets is empty; accepted: samples, time, fixed");
  }
  return budgets;
}

std::vector<SuiteMethod> read_methods(const base::Node& node,
                                      const std::vector<Budget>& suite_budgets) {
  std::vector<SuiteMethod> methods;
  std::set<std::string> ids;
  for (const base::Node& item : node.list("methods")) {
    base::MapReader reader(item, "method");
    const MethodEntry entry = read_entry(reader);
    const GridKeys keys{reader.find("matrix"), reader.find("zip"), reader.find("include"),
                        reader.find("exclude")};
    reader.finish();
    for (const GridPoint& point : parameter_grid(keys)) {
      SuiteMethod method = method_at(entry, point);
      std::vector<base::ParameterSetting> settings = entry.settings;
      for (const auto& [name, value] : point) settings.push_back({name, value});
      check_samples(method, settings, suite_budgets);
      if (!ids.insert(method.id).second) {
        throw base::InputError(reader.require("id").place(),
                               fmt::format("method id \"{}\" is used twice", method.id));
      }
      methods.push_back(std::move(method));
    }
  }
  if (methods.empty()) throw base::InputError(node.place(), "methods is empty");
  return methods;
}

std::string value_text(const base::ParameterValue& value) {
  return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
}

std::vector<Budget> budgets_in_force(const SuiteMethod& method,
                                     const std::vector<Budget>& suite_budgets) {
  if (!method.choice.info->progressive_unit) return {Budget{}};
  return method.budgets.empty() ? suite_budgets : method.budgets;
}

}  // namespace suites
