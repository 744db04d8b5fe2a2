#pragma once

#include <vector>

#include "perception/base/document.h"
#include "suites/suite_file.h"

namespace suites {

/// Reads `methods`, every point of a method's grid as a method of its own.
/// @param suite_budgets  those of methods that state none
/// @throws base::InputError with the place
std::vector<SuiteMethod> read_methods(const base::Node& node,
                                      const std::vector<Budget>& suite_budgets);

/// What a method runs under: its own budgets, else the suite's, less those it cannot have (its own
/// time; counted ones of a renderer without a progressive unit); `fixed` if that leaves none.
std::vector<Budget> budgets_in_force(const SuiteMethod& method,
                                     const std::vector<Budget>& suite_budgets);

/// Whether every budget of the method sets its samples, so that the parameter has no say.
bool are_samples_budgeted(const SuiteMethod& method, const std::vector<Budget>& suite_budgets);

/// @param metrics  texts of the suite's metrics
/// @throws base::InputError for a budget by the error of another metric, or by the time of a method
///   that the suite lacks
void check_budget_targets(const std::vector<SuiteMethod>& methods,
                          const std::vector<Budget>& budgets,
                          const std::vector<std::string>& metrics, const base::Place& place);

/// Whether a method is measured on a scene: on all unless it names some.
bool is_on_scene(const SuiteMethod& method, const SuiteScene& scene);
/// @throws base::InputError for a scene that the suite lacks
void check_method_scenes(const SuiteMethod& method, const std::vector<SuiteScene>& scenes,
                         const base::Place& place);

}  // namespace suites
