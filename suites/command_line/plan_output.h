#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "suites/command_line/console.h"
#include "suites/command_line/suite_selection.h"

namespace suites::command_line {

/// {"schema","status":"ok","suite","file","profile","viewing","scenes":[...],"methods":[...],
///  "metrics":[...],"measure":{...},"cells":[...],"references":[...]}.
/// @param results_root  where stored references are looked for
nlohmann::ordered_json plan_json(const PlannedSuite& planned,
                                 const std::filesystem::path& results_root);

/// The same for a person: scenes with face counts, methods, cells, references.
std::string plan_text(const PlannedSuite& planned, const std::filesystem::path& results_root);

/// Prints one of the two, and what each profile of the suite is expected to cost ("costs").
/// @param selection  what the plan was made of
/// @return kAsExpected, or kNothingMeasured for a plan without cells
int print_plan(const PlannedSuite& planned, const SuiteSelection& selection,
               const std::string& results_option, bool as_json, Console& console);

}  // namespace suites::command_line
