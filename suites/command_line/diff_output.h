#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "metrics/metric_list.h"
#include "suites/command_line/diff_inputs.h"

namespace suites::command_line {

/// One metric of one test image.
struct DiffScore {
  const metrics::MetricChoice* choice = nullptr;
  metrics::Score score;
  std::string map;          ///< path of the EXR, "" if none was written
  std::string map_picture;  ///< path of the false-colour PNG
};

/// All metrics of one test image.
struct DiffResult {
  DiffImage test;
  std::vector<DiffScore> scores;
  std::vector<std::string> violated_gates;  ///< "flip=0.1"
};

/// "ok", or "non_finite" if a pixel that counts is NaN or infinite.
std::string status_of(const DiffResult& result, bool ignores_non_finite);

/// What `discern diff --json` prints (DESIGN section 7); several tests: in "tests".
nlohmann::ordered_json diff_json(const DiffInputs& inputs, const std::vector<DiffResult>& results,
                                 bool ignores_non_finite);

/// The same for a person, viewing conditions and their origins first.
std::string diff_text(const DiffInputs& inputs, const std::vector<DiffResult>& results);

}  // namespace suites::command_line
