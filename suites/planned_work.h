#pragma once

#include "suites/run_plan.h"

namespace suites {

/// How long the steps of a run take, in pixels times samples of a path tracer; only their ratios
/// matter, and only to the remaining time that is shown.
double work_of_reference(const SuiteScene& scene, std::int64_t stored_samples);
double work_of_repetition(const PlannedCell& cell);
double work_of_score(const PlannedCell& cell);

}  // namespace suites
