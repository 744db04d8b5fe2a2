#pragma once

#include <filesystem>
#include <string>

namespace results::figures {

/// The program: $DISCERN_GNUPLOT, else `gnuplot` on $PATH.
/// @throws base::InputError naming the Debian package if it is missing
std::string gnuplot_program();

/// Runs a script in its folder, with a time limit of a minute.
/// @param script  its file name
/// @throws base::InputError with what gnuplot said
void run_gnuplot(const std::filesystem::path& folder, const std::string& script,
                 const std::string& formats);

}  // namespace results::figures
