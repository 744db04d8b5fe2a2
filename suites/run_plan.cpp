#include "suites/run_plan.h"

#include <algorithm>
#include <cassert>
#include <regex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/hash.h"
#include "suites/reference_rendering.h"
#include "suites/suite_methods.h"

namespace suites {
namespace {

/// A method's id as part of a file name: "val[vals=30,vpls=1024]" -> "val-vals-30-vpls-1024".
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
base::Hash cell_hash(const PlannedCell& cell, const renderers::scene::Scene& scene) {
  base::Hasher hasher;
  hasher.add(scene.hash.hex());
  hasher.add(std::int64_t{cell.scene->frame});
  hasher.add(std::int64_t{cell.scene->size_px.width});
  hasher.add(std::int64_t{cell.scene->size_px.height});
  hasher.add(cell.method->choice.info->name);
  hasher.add(std::int64_t{cell.method->choice.info->version});
  hasher.add(cell.method->choice.parameters.to_text());
  hasher.add(cell.budget.name());
  hasher.add(static_cast<std::int64_t>(cell.seed));
  return hasher.finish();
}

std::string cell_name(const PlannedCell& cell, const renderers::scene::Scene& scene) {
  return fmt::format("{}.{}.{}.s{}-{}", cell.scene->id, file_name_part(cell.method->id),
                     cell.budget.name(), cell.seed, cell_hash(cell, scene).short_hex());
}

renderers::Claims reference_claims(const SuiteMethod& method) {
  renderers::Claims claims = method.choice.info->claims(method.choice.parameters);
  claims.part = renderers::Part::all;
  return claims;
}

std::size_t index_of(const RunPlan& plan, const SuiteScene* scene,
                     const renderers::Claims& claims) {
  const auto found =
      std::find_if(plan.references.begin(), plan.references.end(), [&](const auto& reference) {
        return reference.scene == scene && reference.claims == claims;
      });
  return static_cast<std::size_t>(found - plan.references.begin());
}

void add_reference(RunPlan& plan, const SuiteScene* scene, const renderers::Claims& claims) {
  if (index_of(plan, scene, claims) == plan.references.size()) {
    plan.references.push_back({scene, claims});
  }
}

void add_cells(RunPlan& plan, const Suite& suite, const SuiteMethod& method,
               const SuiteScene& suite_scene, const renderers::scene::Scene& scene) {
  const std::vector<std::string> lacking =
      renderers::unsupported_features(*method.choice.info, scene);
  const int seeds = method.choice.info->uses_seed ? suite.measure.seeds : 1;
  for (const Budget& budget : budgets_in_force(method, suite.budgets)) {
    for (int seed = 1; seed <= seeds; ++seed) {
      PlannedCell cell;
      cell.scene = &suite_scene;
      cell.method = &method;
      cell.budget = budget;
      cell.seed = static_cast<std::uint64_t>(seed);
      cell.name = cell_name(cell, scene);
      if (!lacking.empty()) {
        cell.unsupported = fmt::format("renderer \"{}\" does not support {}",
                                       method.choice.info->name, fmt::join(lacking, ", "));
      }
      plan.cells.push_back(std::move(cell));
    }
  }
}

/// Refuses a reference that its renderer cannot make before anything is rendered.
void check_references(const RunPlan& plan, const Suite& suite,
                      const std::vector<renderers::scene::Scene>& scenes) {
  for (const PlannedReference& reference : plan.references) {
    ReferenceKey key;
    key.scene = &scenes[static_cast<std::size_t>(reference.scene - suite.scenes.data())];
    key.size_px = reference.scene->size_px;
    key.claims = reference.claims;
    key.spec = reference.scene->reference;
    reference_method(key);
  }
}

}  // namespace

RunPlan make_plan(const Suite& suite, const std::vector<renderers::scene::Scene>& scenes) {
  assert(scenes.size() == suite.scenes.size());
  RunPlan plan;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const SuiteScene& suite_scene = suite.scenes[i];
    if (!suite.metrics.empty()) add_reference(plan, &suite_scene, renderers::Claims{});
    for (const SuiteMethod& method : suite.methods) {
      add_cells(plan, suite, method, suite_scene, scenes[i]);
      if (suite.metrics.empty() || plan.cells.back().unsupported) continue;
      add_reference(plan, &suite_scene, reference_claims(method));
    }
  }
  check_references(plan, suite, scenes);
  return plan;
}

std::size_t own_reference(const RunPlan& plan, const PlannedCell& cell) {
  return index_of(plan, cell.scene, reference_claims(*cell.method));
}

std::size_t full_reference(const RunPlan& plan, const PlannedCell& cell) {
  return index_of(plan, cell.scene, renderers::Claims{});
}

bool matches_filter(const PlannedCell& cell, const std::string& filter) {
  if (filter.empty()) return true;
  try {
    const std::regex pattern(filter, std::regex::ECMAScript);
    return std::regex_search(cell.name, pattern) || std::regex_search(cell.scene->id, pattern) ||
           std::regex_search(cell.method->id, pattern);
  } catch (const std::regex_error& error) {
    throw base::InputError(
        fmt::format("--filter \"{}\" is not a regular expression: {}", filter, error.what()));
  }
}

}  // namespace suites
