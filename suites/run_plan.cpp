#include "suites/run_plan.h"

#include <algorithm>
#include <cassert>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/errors.h"
#include "perception/base/hash.h"
#include "suites/name_filter.h"
#include "suites/reference_rendering.h"
#include "suites/reference_spec.h"
#include "suites/suite_methods.h"

namespace suites {
namespace {

/// An id as part of a file name: "val[vals=30,vpls=1024]" -> "val-vals-30-vpls-1024".
std::string file_name_part(const std::string& id) {
  std::string name;
  for (const char c : id) {
    const bool is_kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    if (is_kept) {
      name += c;
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name;
}

/// Everything that makes the cell's images; the machine is left out.
base::Hash cell_hash(const PlannedCell& cell) {
  base::Hasher hasher;
  for (const PlannedFrame& frame : cell.frames) {
    hasher.add(frame.state->hash.hex());
    hasher.add(std::int64_t{frame.frame});
  }
  hasher.add(std::int64_t{cell.scene->size_px.width});
  hasher.add(std::int64_t{cell.scene->size_px.height});
  hasher.add(cell.method->choice.info->name);
  hasher.add(std::int64_t{cell.method->choice.info->version});
  hasher.add(cell.method->choice.parameters.to_text());
  hasher.add(cell.budget.name());
  if (is_searched(cell.budget, cell.method->search.has_value()) && cell.method->search) {
    hasher.add(cell.method->search->name);
  }
  hasher.add(static_cast<std::int64_t>(cell.seed));
  return hasher.finish();
}

std::string cell_name(const PlannedCell& cell) {
  return fmt::format("{}.{}.{}.s{}-{}", file_name_part(cell.scene->id),
                     file_name_part(cell.method->id), file_name_part(cell.budget.name()), cell.seed,
                     cell_hash(cell).short_hex());
}

/// A value of the searched setting as its parameter holds it.
base::ParameterValue value_of(const SearchedSetting& setting, double value) {
  if (setting.is_whole) return static_cast<std::int64_t>(value);
  return value;
}

/// @throws base::InputError naming the method whose values do not fit each other
renderers::Claims claims_of(const SuiteMethod& method, const renderers::scene::Scene& state) {
  try {
    return method.choice.info->claims(method.choice.parameters, state);
  } catch (const base::InputError& error) {
    throw base::InputError(fmt::format("method \"{}\": {}", method.id, error.what()));
  }
}

std::vector<PlannedFrame> frames_of(const SuiteMethod& method, const SuiteScene& suite_scene,
                                    const SceneStates& states) {
  std::vector<PlannedFrame> frames;
  for (const int number : suite_scene.frames.numbers()) {
    const renderers::scene::Scene* state = states.frames[frames.size()].get();
    frames.push_back({number, state, claims_of(method, *state)});
  }
  return frames;
}

renderers::Claims reference_claims(renderers::Claims claims) {
  claims.part = renderers::Part::all;
  return claims;
}

std::size_t index_of(const RunPlan& plan, const SuiteScene* scene,
                     const renderers::scene::Scene& state, const renderers::Claims& claims) {
  const auto found =
      std::find_if(plan.references.begin(), plan.references.end(), [&](const auto& reference) {
        return reference.scene == scene && reference.state->hash == state.hash &&
               reference.claims == claims;
      });
  return static_cast<std::size_t>(found - plan.references.begin());
}

/// Frames of one state share its reference.
void add_references(RunPlan& plan, const PlannedCell& cell, bool is_full) {
  for (const PlannedFrame& frame : cell.frames) {
    const renderers::Claims claims = is_full ? renderers::Claims{} : reference_claims(frame.claims);
    if (index_of(plan, cell.scene, *frame.state, claims) < plan.references.size()) continue;
    plan.references.push_back({cell.scene, frame.frame, frame.state, claims, false});
  }
}

/// A setting that changes what is claimed would be searched against one reference and scored
/// against another.
void check_search(const SuiteMethod& method, const SuiteScene& scene, const SceneStates& states) {
  if (!method.search || method.search->name == "samples") return;
  MethodChoice least = method.choice;
  MethodChoice most = method.choice;
  least.parameters.set(method.search->name, value_of(*method.search, method.search->from));
  most.parameters.set(method.search->name, value_of(*method.search, method.search->to));
  const renderers::RendererInfo& info = *method.choice.info;
  for (const auto& state : states.frames) {
    if (info.claims(least.parameters, *state) == info.claims(most.parameters, *state)) continue;
    throw base::InputError(
        fmt::format("scene {}: {} of method \"{}\" changes what the method claims, so no search "
                    "can compare its "
                    "values; accepted: a setting that keeps transport, part and geometry_clamp",
                    scene.id, method.search->name, method.id));
  }
}

void add_cells(RunPlan& plan, const Suite& suite, const SuiteMethod& method,
               const SuiteScene& suite_scene, const SceneStates& states) {
  const std::vector<std::string> lacking =
      renderers::unsupported_features(*method.choice.info, states.first());
  check_search(method, suite_scene, states);
  PlannedCell cell;
  cell.measure = with_change(with_change(suite.measure, suite_scene.measure), method.measure);
  const int seeds = method.choice.info->uses_seed ? cell.measure.seeds : 1;
  cell.scene = &suite_scene;
  cell.method = &method;
  cell.frames = frames_of(method, suite_scene, states);
  if (!lacking.empty()) {
    cell.unsupported = fmt::format("renderer \"{}\" does not support {}", method.choice.info->name,
                                   fmt::join(lacking, ", "));
  }
  for (const Budget& budget : budgets_in_force(method, suite.budgets)) {
    for (int seed = 1; seed <= seeds; ++seed) {
      cell.budget = budget;
      cell.seed = static_cast<std::uint64_t>(seed);
      cell.name = cell_name(cell);
      plan.cells.push_back(cell);
    }
  }
}

/// Refuses a reference that its renderer cannot make, and an own one that nothing is scored
/// against, before anything is rendered.
void check_references(const RunPlan& plan) {
  std::map<const SuiteScene*, bool> has_own;
  for (const PlannedReference& reference : plan.references) {
    const ReferenceKey key = reference_key(reference);
    reference_method(key);
    if (reference.scene->reference.own) has_own[reference.scene] |= key.spec.own.has_value();
  }
  for (const auto& [scene, is_used] : has_own) {
    if (is_used) continue;
    throw base::InputError(fmt::format(
        "scene {}: its own reference, {}, claims what no method here claims; accepted: a method "
        "with the same transport, geometry_clamp and part all",
        scene->id, scene->reference.own->choice.info->name));
  }
}

}  // namespace

RunPlan make_plan(const Suite& suite, const std::vector<SceneStates>& scenes) {
  assert(scenes.size() == suite.scenes.size());
  RunPlan plan;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (const SuiteMethod& method : suite.methods) {
      if (!is_on_scene(method, suite.scenes[i])) continue;
      const std::size_t first_cell = plan.cells.size();
      add_cells(plan, suite, method, suite.scenes[i], scenes[i]);
      if (suite.metrics.empty()) continue;
      const PlannedCell& cell = plan.cells[first_cell];
      add_references(plan, cell, true);
      if (!cell.unsupported) add_references(plan, cell, false);
    }
  }
  const bool needs_aovs = std::any_of(suite.metrics.begin(), suite.metrics.end(),
                                      [](const SuiteMetric& one) { return one.needs_aovs(); });
  for (PlannedReference& reference : plan.references) reference.needs_aovs = needs_aovs;
  check_references(plan);
  return plan;
}

std::size_t own_reference(const RunPlan& plan, const PlannedCell& cell, const PlannedFrame& frame) {
  return index_of(plan, cell.scene, *frame.state, reference_claims(frame.claims));
}

std::size_t full_reference(const RunPlan& plan, const PlannedCell& cell,
                           const PlannedFrame& frame) {
  return index_of(plan, cell.scene, *frame.state, renderers::Claims{});
}

ReferenceKey reference_key(const PlannedReference& reference) {
  ReferenceKey key;
  key.scene = reference.state;
  key.size_px = reference.scene->size_px;
  key.claims = reference.claims;
  key.needs_aovs = reference.needs_aovs;
  key.spec = reference_spec_for(reference.scene->reference, *reference.state, reference.claims);
  return key;
}

std::optional<std::int64_t> samples_of(const PlannedCell& cell) {
  if (cell.found && cell.found->name == "samples") {
    return static_cast<std::int64_t>(cell.found->value);
  }
  return cell.budget.samples;
}

std::optional<double> time_limit_s(const PlannedCell& cell) {
  if (is_searched(cell.budget, cell.method->search.has_value())) return std::nullopt;
  return cell.budget.time_s;
}

results::ParameterValues found_parameters(const PlannedCell& cell) {
  if (!cell.found || cell.found->name == "samples") return {};
  return {{cell.found->name, value_of(*cell.method->search, cell.found->value)}};
}

bool matches_filter(const PlannedCell& cell, const std::string& filter) {
  const NameFilter wanted(filter);
  return wanted.matches(cell.name) || wanted.matches(cell.scene->id) ||
         wanted.matches(cell.method->id);
}

}  // namespace suites
