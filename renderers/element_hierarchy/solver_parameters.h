#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/renderer.h"
#include "renderers/element_hierarchy/radiosity_solver.h"

namespace renderers::element_hierarchy {

/// Parameters of the radiosity solution, the same for every technique that makes one.
std::vector<base::ParameterSpec> solver_parameters();
SolverSettings solver_settings_of(const base::Parameters& parameters);
/// What preset `paper` sets of them.
std::vector<std::pair<std::string, base::ParameterValue>> paper_solver_values();

/// Counters of a solution, for a frame; all 0 without one. @param solution  may be null
std::vector<std::pair<std::string, CounterValue>> solution_counters(const Solution* solution);

}  // namespace renderers::element_hierarchy
