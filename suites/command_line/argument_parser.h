#pragma once

#include <string>
#include <vector>

#include "suites/command_line/verb_arguments.h"

namespace suites::command_line {

/// Reads the command line after the program's name. Names of scenes, renderers and so on are not
/// looked up here.
///
/// @throws base::InputError for an unknown verb or option (with the nearest known one), a missing
///   or surplus argument, or a value of the wrong kind
VerbArguments parse_arguments(const std::vector<std::string>& words);

}  // namespace suites::command_line
