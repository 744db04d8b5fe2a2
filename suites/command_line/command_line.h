#pragma once

#include <string>
#include <vector>

#include "suites/command_line/console.h"

namespace suites::command_line {

/// The program: parses, runs the verb, turns every error into a message and an exit code.
/// @param words  the command line after the program's name
/// @return the exit code of DESIGN section 5
int run_command_line(const std::vector<std::string>& words, Console& console);

}  // namespace suites::command_line
