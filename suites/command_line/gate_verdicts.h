#pragma once

#include <filesystem>
#include <string>

#include "results/gates/gate_check.h"
#include "results/gates/run_gates.h"
#include "results/result_store.h"
#include "suites/command_line/console.h"

namespace suites::command_line {

using results::gates::gates_against;
using results::gates::judged_gates;
using results::gates::require_baseline;
using results::gates::unjudged_gates;

/// kGateFailed if one failed; with `strict` kInconclusive if one is not judged.
int gate_code(const results::gates::GateReport& report, bool strict);

/// What did not pass, and counts; nothing for a run without gates.
void print_gates(const results::gates::GateReport& report, Console& console);

/// junit.xml of the run folder, and of `copy` if that is not "".
void write_junit(const results::Run& run, const results::gates::GateReport& report,
                 const std::string& copy);

}  // namespace suites::command_line
