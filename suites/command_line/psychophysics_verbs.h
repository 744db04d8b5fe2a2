#pragma once

#include <filesystem>

#include "suites/command_line/console.h"
#include "suites/command_line/verb_arguments.h"

/// What the verbs do with suites and runs of kind psychophysics. Each returns an exit code.
namespace suites::command_line {

/// True if the selection is a suite file of that kind. @throws base::InputError as `find_suite`
bool is_psychophysics(const SuiteSelection& selection);

int check_psychophysics(const CheckArguments& arguments, Console& console);
int run_psychophysics_suite(const RunArguments& arguments, Console& console);
int report_psychophysics(const std::filesystem::path& run_folder, bool as_json, Console& console);

}  // namespace suites::command_line
