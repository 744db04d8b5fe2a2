#include "suites/suite_methods.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "perception/base/names.h"
#include "results/row_selector.h"
#include "suites/parameter_grid.h"
#include "suites/safe_name.h"

namespace suites {
namespace {

/// A method's entry, before its grid is expanded.
struct MethodEntry {
  std::string id;
  base::Place place;
  const renderers::RendererInfo* info = nullptr;
  const base::Preset* preset = nullptr;
  std::vector<base::ParameterSetting> settings;
  std::vector<std::string> scenes;
  std::vector<Budget> budgets;
  std::optional<SearchedSetting> search;
  MeasureChange measure;
};

/// Whether a method can run under a budget: without a progressive unit there is nothing to count or
/// to stop, but a setting may be searched.
bool can_have(const Budget& budget, const renderers::RendererInfo& info, bool has_search) {
  if (info.progressive_unit || budget == Budget{}) return true;
  return has_search && is_searched(budget, has_search);
}

void check_budgets(const MethodEntry& entry, const base::Node& node) {
  const bool can_have_all =
      std::all_of(entry.budgets.begin(), entry.budgets.end(), [&](const Budget& budget) {
        return can_have(budget, *entry.info, entry.search.has_value());
      });
  if (can_have_all) return;
  throw base::InputError(
      node.place(),
      fmt::format("renderer \"{}\" has no progressive unit and runs once; accepted budgets: fixed, "
                  "and by time or error with `search` of a parameter",
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
  if (const base::Node* scenes = reader.find("scenes")) {
    for (const base::Node& id : scenes->list("scenes")) entry.scenes.push_back(id.text("scene"));
    if (entry.scenes.empty()) throw base::InputError(scenes->place(), "scenes is empty");
  }
  if (const base::Node* search = reader.find("search")) {
    entry.search = read_search(*search, *entry.info);
  }
  if (const base::Node* measure = reader.find("measure")) {
    entry.measure = read_measure_change(*measure);
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
  if (!are_samples_budgeted(method, suite_budgets)) return;
  throw base::InputError(setting->value.place(),
                         fmt::format("samples of method \"{}\" is set by its budgets; leave it out "
                                     "here, or write budgets: [fixed]",
                                     method.id));
}

/// A setting that is searched has no value of its own.
void check_search(const MethodEntry& entry, const std::vector<base::ParameterSetting>& settings) {
  if (!entry.search) return;
  for (const base::ParameterSetting& setting : settings) {
    if (!base::is_same_name(setting.name, entry.search->name)) continue;
    throw base::InputError(
        setting.value.place(),
        fmt::format("{} of method \"{}\" is searched and set here, too; keep one", setting.name,
                    entry.id));
  }
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
  check_search(entry, settings);
  SuiteMethod method;
  method.base_id = entry.id;
  method.choice.info = entry.info;
  method.choice.preset = entry.preset->name;
  method.choice.parameters = base::resolve_parameters(
      entry.info->parameters, entry.preset, settings,
      fmt::format("renderer \"{}\" (method \"{}\")", entry.info->name, entry.id));
  method.scenes = entry.scenes;
  method.budgets = entry.budgets;
  method.search = entry.search;
  method.measure = entry.measure;
  for (const auto& [name, node] : point) {
    for (const auto& [known, value] : method.choice.parameters.entries()) {
      if (base::is_same_name(known, name)) method.sweep.emplace_back(known, value);
    }
  }
  method.id = entry.id;
  for (std::size_t i = 0; i < method.sweep.size(); ++i) {
    method.id += fmt::format("{}{}={}", i == 0 ? "[" : ",", method.sweep[i].first,
                             results::text_of(method.sweep[i].second));
  }
  if (!method.sweep.empty()) method.id += "]";
  return method;
}

}  // namespace

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

bool are_samples_budgeted(const SuiteMethod& method, const std::vector<Budget>& suite_budgets) {
  if (!method.choice.info->progressive_unit) return false;
  const bool has_other_search = method.search && method.search->name != "samples";
  const std::vector<Budget> budgets = budgets_in_force(method, suite_budgets);
  return std::all_of(budgets.begin(), budgets.end(), [&](const Budget& budget) {
    if (budget == Budget{}) return false;
    return !(has_other_search && is_searched(budget, true));
  });
}

std::vector<Budget> budgets_in_force(const SuiteMethod& method,
                                     const std::vector<Budget>& suite_budgets) {
  std::vector<Budget> budgets = method.budgets.empty() ? suite_budgets : method.budgets;
  std::erase_if(budgets, [&](const Budget& budget) {
    const bool is_own_time = budget.time_of == method.id;
    return is_own_time || !can_have(budget, *method.choice.info, method.search.has_value());
  });
  if (budgets.empty()) budgets.emplace_back();
  return budgets;
}

bool is_on_scene(const SuiteMethod& method, const SuiteScene& scene) {
  return method.scenes.empty() ||
         std::any_of(method.scenes.begin(), method.scenes.end(),
                     [&](const std::string& id) { return id == scene.id || id == scene.base_id; });
}

void check_method_scenes(const SuiteMethod& method, const std::vector<SuiteScene>& scenes,
                         const base::Place& place) {
  std::vector<std::string> known;
  for (const SuiteScene& scene : scenes) {
    for (const std::string& id : {scene.base_id, scene.id}) {
      if (std::find(known.begin(), known.end(), id) == known.end()) known.push_back(id);
    }
  }
  for (const std::string& id : method.scenes) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    throw base::InputError(
        place, fmt::format("method \"{}\": {}", method.id, base::unknown_name("scene", id, known)));
  }
}

void check_budget_targets(const std::vector<SuiteMethod>& methods,
                          const std::vector<Budget>& budgets,
                          const std::vector<std::string>& metrics, const base::Place& place) {
  for (const Budget& budget : budgets) {
    if (budget.error &&
        std::find(metrics.begin(), metrics.end(), budget.error->metric) == metrics.end()) {
      throw base::InputError(
          place,
          fmt::format("budget by error: \"{}\" is none of this suite's metrics; add it to them",
                      budget.error->metric));
    }
    if (budget.time_of.empty()) continue;
    std::vector<std::string> ids;
    for (const SuiteMethod& method : methods) ids.push_back(method.id);
    const auto target = std::find(ids.begin(), ids.end(), budget.time_of);
    if (target == ids.end()) {
      throw base::InputError(
          place, "budget of equal time: " + base::unknown_name("method", budget.time_of, ids));
    }
  }
}

}  // namespace suites
