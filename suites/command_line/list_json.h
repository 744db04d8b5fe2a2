#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace suites::command_line {

/// Entries of `discern list ... --json` (DESIGN section 7), an array each. A scene or suite that
/// cannot be read is an entry with `reason` and nulls, never a missing row.
nlohmann::ordered_json renderers_json();
nlohmann::ordered_json metrics_json();
nlohmann::ordered_json scenes_json();
nlohmann::ordered_json suites_json();
/// The processor, then every graphics platform, each tried out in a process of its own.
nlohmann::ordered_json devices_json();

/// Entries of names alone, without a look at what they name.
nlohmann::ordered_json renderer_names();
nlohmann::ordered_json metric_names();
nlohmann::ordered_json scene_names();
nlohmann::ordered_json suite_names();
nlohmann::ordered_json device_names();

/// The entries whose name matches a regular expression; all for "".
/// @throws base::InputError if it is not a regular expression
nlohmann::ordered_json with_names_matching(const nlohmann::ordered_json& entries,
                                           const std::string& filter);

}  // namespace suites::command_line
