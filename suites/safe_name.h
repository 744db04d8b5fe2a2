#pragma once

#include <string>

#include "perception/base/document.h"

namespace suites {

/// An id of a suite file: a scalar that can be a file name.
/// @param what  names it in the message @throws base::InputError with the place
std::string read_safe_name(const base::Node& node, const char* what);

}  // namespace suites
