#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/run_values.h"
#include "results/statistics.h"
#include "results/tables.h"

/// The least time whose error stays below a visible threshold.
namespace results {

/// Where a row's error lies.
enum class Visibility {
  below,      ///< the score's whole interval; of a single seed its value
  undecided,  ///< the interval reaches across, or the reference's own noise does
  above,
  unknown  ///< no finite score, or no time
};
std::string to_string(Visibility visibility);

/// A setting of a scene: a row, or the point of a row's convergence curve that reaches the limit.
struct Candidate {
  std::string method;
  std::string budget;
  std::optional<Estimate> time_s;  ///< total_s; of sequences next_frame_s
  std::optional<Estimate> score;   ///< of a curve's point the limit itself
  Visibility visibility = Visibility::unknown;
  bool is_on_curve = false;
  bool is_cheapest = false;  ///< the least time of those below
  bool is_tied = false;      ///< below, too, and not slower beyond the noise
  std::string reason;        ///< of undecided and unknown
};

struct CheapestOfScene {
  std::string scene;
  std::vector<Candidate> candidates;  ///< those below first, then by time
};

/// @param metric   a score of the run, "flip" or "flip.p99"; lower must be better
/// @param against  own | full
/// @param limit    greatest score that counts as below
/// @throws base::InputError for an unknown metric, and for one that is better when higher
std::vector<CheapestOfScene> cheapest_settings(const RunValues& run, const std::string& metric,
                                               const std::string& against, double limit);

/// A row per candidate: scene, method, budget, time, score, verdict.
Table cheapest_table(const std::vector<CheapestOfScene>& scenes, const std::string& score,
                     double limit);
/// A list of {"scene","cheapest":{...}|null,"candidates":[...]}.
nlohmann::ordered_json to_json(const std::vector<CheapestOfScene>& scenes);

}  // namespace results
