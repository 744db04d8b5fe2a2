#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "perception/base/child_process.h"

namespace tests {

/// True if Debian's Chromium is installed.
bool has_browser();

/// Opens a page from disk in headless Chromium, 1400x2400, and waits for its end.
/// @param profile  a folder for the browser's own files
/// @param options  e.g. "--dump-dom", "--screenshot=FILE"
base::CommandResult browse(const std::filesystem::path& page, const std::filesystem::path& profile,
                           const std::vector<std::string>& options);

/// Lines that the page itself wrote to the console, from the browser's log.
std::string console_lines(const std::string& log);

}  // namespace tests
