#pragma once

#include <filesystem>
#include <string>

#include "results/gates/gate_check.h"
#include "results/result_store.h"
#include "suites/command_line/console.h"

namespace suites::command_line {

/// The run's gates, as its run.json has them, judged against the accepted baseline.
/// @throws base::InputError if the baseline cannot be read
results::gates::GateReport judged_gates(const std::filesystem::path& results_root,
                                        const results::Run& run);

/// The same against another run.
results::gates::GateReport gates_against(const results::Run& before, const results::Run& after);
/// The same by other gates than those of the run's suite.
results::gates::GateReport gates_against(const results::Run& before, const results::Run& after,
                                         const std::vector<results::gates::Gate>& gates);

/// The gates of a run that was stopped, or of one that never got to them: none is judged.
results::gates::GateReport unjudged_gates(const results::Run& run, const std::string& reason);

/// The accepted run of the same suite, profile and machine.
/// @throws base::InputError naming the file that is missing and how to make it
results::Run require_baseline(const std::filesystem::path& results_root, const results::Run& run);

/// kGateFailed if one failed; with `strict` kInconclusive if one is not judged.
int gate_code(const results::gates::GateReport& report, bool strict);

/// What did not pass, and counts; nothing for a run without gates.
void print_gates(const results::gates::GateReport& report, Console& console);

/// junit.xml of the run folder, and of `copy` if that is not "".
void write_junit(const results::Run& run, const results::gates::GateReport& report,
                 const std::string& copy);

}  // namespace suites::command_line
