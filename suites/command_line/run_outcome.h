#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "results/html_report/html_report.h"
#include "suites/command_line/console.h"
#include "suites/command_line/verb_arguments.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

/// What `discern run` hands to the runner of either kind of suite.
RunOptions run_options(const RunArguments& arguments);

/// {"schema","status","run","report","cells","failed","skipped",...}: schemas/run.json.
nlohmann::ordered_json outcome_json(const RunOutcome& outcome, const std::string& report);

/// Writes the report of a run; says on stderr where its data went to files of their own.
results::html_report::ReportFiles write_run_report(
    const results::Run& run, Console& console,
    const results::html_report::ReportOptions& options = {});

/// What `discern report` says of a page it has written.
struct WrittenReport {
  std::string run;
  std::string report;
  std::size_t repetitions = 0;
  std::size_t scores = 0;
  std::size_t unreadable_lines = 0;
  bool is_split = false;         ///< float images and previews are in files of their own
  std::uint64_t data_bytes = 0;  ///< of the float images, as text
};
/// Prints it, as text or by schemas/report.json. @return kAsExpected
int print_report(const WrittenReport& written, bool as_json, Console& console);

}  // namespace suites::command_line
