#pragma once

#include <string>
#include <vector>

#include "suites/suite_file.h"

namespace suites {

/// One (scene, method, budget, seed) of a suite.
struct PlannedCell {
  std::string name;  ///< <scene>.<method>.<budget>.s<seed>-<8 hex of the cell's hash>, path-safe
  const SuiteScene* scene = nullptr;
  const SuiteMethod* method = nullptr;
  Budget budget;
  std::uint64_t seed = 1;
  std::optional<std::string> unsupported;  ///< features the renderer lacks
};

/// A reference image that the cells need.
struct PlannedReference {
  const SuiteScene* scene = nullptr;
  renderers::Claims claims;  ///< part is always `all`: direct and indirect are kept as parts
};

struct RunPlan {
  std::vector<PlannedCell> cells;            ///< scenes, then methods, budgets, seeds in file order
  std::vector<PlannedReference> references;  ///< each once
};

/// Pure function of the suite and the states of its scenes.
/// @param scenes  one per suite scene, in order
/// @throws base::InputError if a scene's reference renderer cannot render what its methods claim
RunPlan make_plan(const Suite& suite, const std::vector<renderers::scene::Scene>& scenes);

/// Index of the reference for what a method claims, and for `full`.
std::size_t own_reference(const RunPlan& plan, const PlannedCell& cell);
std::size_t full_reference(const RunPlan& plan, const PlannedCell& cell);

/// True if the cells named by scene, method or cell name match a filter (ECMAScript regex).
bool matches_filter(const PlannedCell& cell, const std::string& filter);

}  // namespace suites
