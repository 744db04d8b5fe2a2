#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace results {

/// One line of searches.jsonl: how the setting of a (scene, method, budget) was found that meets a
/// target time or error on this machine.
struct SearchRecord {
  struct Probe {
    double setting = 0.0;
    double measured = 0.0;
  };
  std::string scene;
  std::string method;
  std::string budget;
  std::string setting;   ///< "samples" or a parameter
  std::string quantity;  ///< what has a target: "total_s", "next_frame_s", or a metric's text
  double target = 0.0;
  std::optional<double> value;     ///< of the setting, found; absent: there is none
  std::optional<double> achieved;  ///< measured at it
  /// met | nearest | below_reach | beyond_reach | below_noise_floor | failed
  std::string outcome;
  std::string reason;         ///< one sentence; "" if the target was met
  std::vector<Probe> probes;  ///< every render of the search, in order
};
nlohmann::ordered_json to_json(const SearchRecord& record);
/// @throws base::InputError naming the missing or mistyped field
SearchRecord search_record_from_json(const nlohmann::ordered_json& json);

}  // namespace results
