#pragma once

#include <string>

#include "suites/command_line/verb_spec.h"

namespace suites::command_line {

/// Scripts by which a shell completes verbs, options and the names that they take; names of suites,
/// scenes, renderers and metrics are asked of the program when they are wanted.
std::string bash_completions(const Verbs& verbs);
std::string zsh_completions(const Verbs& verbs);
std::string fish_completions(const Verbs& verbs);

}  // namespace suites::command_line
