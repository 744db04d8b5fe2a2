#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/result_store.h"
#include "suites/reference_images.h"
#include "suites/run_plan.h"
#include "suites/suite_runner.h"

namespace suites {

enum class RunState { running, complete, interrupted };
std::string to_string(RunState state);

/// What results must share to stand in one run: {"build","machine","threads","platform"}.
///
/// `build` is the hash of the worker's executable.
nlohmann::ordered_json run_identity(const RunOptions& options);

/// {"vals": 30, "view": "front"}: the sweep values of a method or a scene.
nlohmann::ordered_json sweep_to_json(const results::ParameterValues& sweep);

/// {"transport","part","geometry_clamp"}
nlohmann::ordered_json to_json(const renderers::Claims& claims);

/// What became of a reference, for run.json:
/// {"scene","frame","transport","geometry_clamp","hash","samples", "pixel_hash","seconds"}, or
/// "reason" where it could not be made.
nlohmann::ordered_json reference_entry(const PlannedReference& planned, const ReferenceKey& key,
                                       const Reference& reference);
nlohmann::ordered_json failed_reference_entry(const PlannedReference& planned,
                                              const std::string& reason);

/// A run of the plan without any record, for what can be known before one.
results::Run planned_run(const Suite& suite, const std::vector<SceneStates>& scenes,
                         const RunPlan& plan);

/// What the suite's claims, figures and gates name must be there.
/// @throws base::InputError with the place
void check_named_quantities(const Suite& suite, const std::vector<SceneStates>& scenes,
                            const RunPlan& plan);

/// The part of run.json that is known when a run starts: run, suite, profile, command, identity,
/// environment, viewing, scenes, methods, budgets, metrics, planned_cells, timing policy.
nlohmann::ordered_json describe_run(const Suite& suite, const std::vector<SceneStates>& scenes,
                                    const RunPlan& plan, const RunOptions& options,
                                    const std::string& run);

}  // namespace suites
