#pragma once

#include <string>

#include "suites/command_line/verb_spec.h"

namespace suites::command_line {

/// The manual page discern(1) as roff of man(7), of the same words as --help.
std::string manual_page(const Verbs& verbs, const std::string& version);

}  // namespace suites::command_line
