#pragma once

#include <string>

#include "perception/base/document.h"

namespace suites {

/// An id of a suite file: a scalar that can be a file name.
/// @param what  names it in the message @throws base::InputError with the place
std::string read_safe_name(const base::Node& node, const char* what);

/// @throws base::InputError with the place unless the name can be a file name
void require_safe_name(const std::string& name, const char* what, const base::Place& place);

}  // namespace suites
