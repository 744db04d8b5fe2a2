#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace base {

/// A position in a text file; line and column count from 1, 0 means "not known".
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", or as much of it as is known.
std::string to_string(const Place& place);

/// The world gave us something we cannot use: a file, a parameter, a name.
///
/// The message says what is wrong, where, the value found, and what would be accepted.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message);
  InputError(const Place& place, const std::string& message);
};

/// A device, driver or library failed: GL, Embree, memory, a missing shared library.
class DeviceError : public std::runtime_error {
 public:
  explicit DeviceError(const std::string& message);
};

/// The sentence for a name that is not in a table, with the nearest known name if one is near.
///
/// @param kind   what the name stands for, e.g. "renderer"
/// @param name   the name as given
/// @param known  the accepted names, in the order to print them
/// @return  `unknown renderer "pth"; did you mean "path"? known: blank, path`
std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string> known);

}  // namespace base
