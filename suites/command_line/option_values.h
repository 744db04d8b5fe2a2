#pragma once

#include <cstdint>
#include <string>

namespace suites::command_line {

/// The whole number that an option was given. @param low  least accepted; the most is 2^31 - 1
/// @throws base::InputError naming the option and what it accepts
std::int64_t parse_integer_option(const std::string& text, const std::string& option,
                                  std::int64_t low);

/// The number that an option was given. @throws base::InputError, also for NaN and infinity
double parse_number_option(const std::string& text, const std::string& option);

/// A share that an option was given, "0.05" or "5%". @throws base::InputError, also outside (0, 1)
double parse_share_option(const std::string& text, const std::string& option);

/// Makes the folder that an option names, and those above it.
/// @throws base::InputError with option, path and the system's reason
void make_folder_of_option(const std::string& folder, const std::string& option);

}  // namespace suites::command_line
