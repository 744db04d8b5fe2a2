#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "suites/command_line/verb_arguments.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

/// What `discern run` hands to the runner of either kind of suite.
RunOptions run_options(const RunArguments& arguments);

/// {"schema","status","run","report","cells","failed","skipped",...}: schemas/run.json.
nlohmann::ordered_json outcome_json(const RunOutcome& outcome, const std::string& report);

}  // namespace suites::command_line
