#pragma once

#include <string>
#include <vector>

#include "suites/suite_file.h"
#include "suites/suite_scenes.h"

namespace suites {

struct ReferenceKey;

/// One frame of a cell.
struct PlannedFrame {
  int frame = 0;
  const renderers::scene::Scene* state = nullptr;
  renderers::Claims claims;  ///< of the method in this state: bounds may follow the scene's size
};

/// The value of a setting that a budget by time or error is met with.
struct FoundSetting {
  std::string name;  ///< "samples" or a parameter
  double value = 0.0;
};

/// One (scene, method, budget, seed) of a suite.
struct PlannedCell {
  std::string name;  ///< <scene>.<method>.<budget>.s<seed>-<8 hex of the cell's hash>, path-safe
  const SuiteScene* scene = nullptr;
  const SuiteMethod* method = nullptr;
  Budget budget;
  std::uint64_t seed = 1;
  MeasurePlan measure;  ///< the suite's as scene and method change it; not part of its hash
  std::vector<PlannedFrame> frames;        ///< one, or those of a sequence
  std::optional<std::string> unsupported;  ///< features the renderer lacks
  std::optional<FoundSetting> found;       ///< once its budget was solved; not part of its hash
  std::optional<std::string> no_setting;   ///< why its budget cannot be met
};

/// A reference image that the cells need.
struct PlannedReference {
  const SuiteScene* scene = nullptr;
  int frame = 0;  ///< the first one of this state
  const renderers::scene::Scene* state = nullptr;
  renderers::Claims claims;  ///< part is always `all`: direct and indirect are kept as parts
  bool needs_aovs = false;   ///< a metric of the suite looks at AOVs, which own pictures keep
};

struct RunPlan {
  std::vector<PlannedCell> cells;            ///< scenes, then methods, budgets, seeds in file order
  std::vector<PlannedReference> references;  ///< each once
};

/// Pure function of the suite and the states of its scenes.
/// @param scenes  one per suite scene, in order; the plan points into them
/// @throws base::InputError if a scene's reference renderer cannot render what its methods claim
RunPlan make_plan(const Suite& suite, const std::vector<SceneStates>& scenes);

/// Index of the reference of a frame of the cell: for what its method claims, and for `full`.
std::size_t own_reference(const RunPlan& plan, const PlannedCell& cell, const PlannedFrame& frame);
std::size_t full_reference(const RunPlan& plan, const PlannedCell& cell, const PlannedFrame& frame);

/// What the reference store knows a planned reference by; points into the scenes.
ReferenceKey reference_key(const PlannedReference& reference);

/// Samples that a cell is rendered with, of its budget or found for it; nothing if neither says.
std::optional<std::int64_t> samples_of(const PlannedCell& cell);
/// The clock that a progressive renderer stops by; nothing where a setting is searched instead.
std::optional<double> time_limit_s(const PlannedCell& cell);
/// The parameter that was found for the cell, if it is not its samples.
results::ParameterValues found_parameters(const PlannedCell& cell);

/// True if the cells named by scene, method or cell name match a filter (ECMAScript regex).
bool matches_filter(const PlannedCell& cell, const std::string& filter);

}  // namespace suites
