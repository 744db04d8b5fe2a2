#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/gates/gate_check.h"
#include "results/result_store.h"

namespace results::gates {

/// The run's gates, as its run.json has them, judged against the accepted baseline.
/// @throws base::InputError if the baseline cannot be read
GateReport judged_gates(const std::filesystem::path& results_root, const Run& run);

/// The same against another run.
GateReport gates_against(const Run& before, const Run& after);
/// The same by other gates than those of the run's suite.
GateReport gates_against(const Run& before, const Run& after, const std::vector<Gate>& gates);

/// The gates of a run that was stopped, or of one that never got to them: none is judged.
GateReport unjudged_gates(const Run& run, const std::string& reason);

/// The accepted run of the same suite, profile and machine.
/// @throws base::InputError naming the file that is missing and how to make it
Run require_baseline(const std::filesystem::path& results_root, const Run& run);

}  // namespace results::gates
