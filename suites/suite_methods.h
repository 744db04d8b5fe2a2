#pragma once

#include <vector>

#include "perception/base/document.h"
#include "suites/suite_file.h"

namespace suites {

/// Reads `budgets`: [{samples: 64}, {samples: [16, 64]}, {time: 10s}, fixed].
/// @throws base::InputError with the place for anything else, error budgets included
std::vector<Budget> read_budgets(const base::Node& node);

/// Reads `methods`, every point of a method's grid as a method of its own.
/// @param suite_budgets  those of methods that state none
/// @throws base::InputError with the place
std::vector<SuiteMethod> read_methods(const base::Node& node,
                                      const std::vector<Budget>& suite_budgets);

/// "30", "0.5", "true", "ray": a parameter's value as it stands in method ids.
std::string value_text(const base::ParameterValue& value);

/// What a method runs under: `fixed` alone for a renderer without a progressive unit, else its own
/// budgets, else the suite's.
std::vector<Budget> budgets_in_force(const SuiteMethod& method,
                                     const std::vector<Budget>& suite_budgets);

}  // namespace suites
