#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "suites/command_line/console.h"
#include "suites/command_line/verb_arguments.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

/// What `discern run` hands to the runner of either kind of suite.
RunOptions run_options(const RunArguments& arguments);

/// {"schema","status","run","report","cells","failed","skipped",...}: schemas/run.json.
nlohmann::ordered_json outcome_json(const RunOutcome& outcome, const std::string& report);

/// What `discern report` says of a page it has written.
struct WrittenReport {
  std::string run;
  std::string report;
  std::size_t repetitions = 0;
  std::size_t scores = 0;
  std::size_t unreadable_lines = 0;
};
/// Prints it, as text or by schemas/report.json. @return kAsExpected
int print_report(const WrittenReport& written, bool as_json, Console& console);

}  // namespace suites::command_line
