#pragma once

#include <string>
#include <string_view>

namespace base {

/// The name in output form for names: lower case, `_` becomes `-`.
std::string kebab_case(std::string_view name);

/// The name in output form for keys, parameters and enumerators: lower case, `-` becomes `_`.
std::string snake_case(std::string_view name);

/// True if the names are equal up to case and the exchange of `-` and `_`.
bool is_same_name(std::string_view a, std::string_view b);

/// True if the name can be a file name everywhere: letters, digits, `.`, `_`, `-`, not empty, not
/// starting with `.` or `-`.
bool is_path_safe(std::string_view name);

}  // namespace base
