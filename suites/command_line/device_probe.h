#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace suites::command_line {

/// What --device accepts: "auto" and the graphics platforms.
std::vector<std::string> known_devices();

/// How long a graphics platform may take to show itself.
inline constexpr std::chrono::seconds kProbeTimeLimit{20};

/// An entry of `discern list devices --json`: what a graphics platform offers. It is tried out by
/// `<program> probe-device <platform>`, since a driver may crash or hang; then, and where it has
/// nothing to offer, `reason` says so and the other values are null.
nlohmann::ordered_json probed_device(const std::string& platform,
                                     const std::filesystem::path& program,
                                     std::chrono::duration<double> limit);

}  // namespace suites::command_line
