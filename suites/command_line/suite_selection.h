#pragma once

#include <memory>
#include <string>
#include <vector>

#include "suites/command_line/verb_arguments.h"
#include "suites/reference_images.h"
#include "suites/run_plan.h"
#include "suites/suite_file.h"
#include "suites/suite_scenes.h"

namespace suites::command_line {

/// The suite of a command line: a file with the overrides applied, or an ad-hoc suite.
/// @throws base::InputError for unknown names, and for a suite given together with ad-hoc options
Suite select_suite(const SuiteSelection& selection);

/// A suite with its scenes loaded and its cells planned.
struct PlannedSuite {
  std::unique_ptr<const Suite> suite;  ///< the plan points into it
  std::vector<SceneStates> scenes;     ///< and into them
  RunPlan plan;
};

/// Loads every scene and plans the cells that the filter matches ("" for all).
/// @throws base::InputError if the filter is not a regular expression
PlannedSuite plan_suite(Suite suite, const std::string& filter);
/// Same of scenes that are loaded already, one entry per scene of the suite in order.
PlannedSuite plan_suite(Suite suite, std::vector<SceneStates> scenes, const std::string& filter);

}  // namespace suites::command_line
