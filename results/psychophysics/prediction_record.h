#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/run_record.h"

namespace results::psychophysics {

/// One line of cells.jsonl: what one model says of one stimulus.
struct PredictionRecord {
  std::string run;
  std::string experiment;
  std::string stimulus;
  std::string model;
  /// ok (also where nothing is seen), unsupported (no question for this model), non_finite, crash.
  Status status = Status::ok;
  std::optional<std::string> reason;  ///< always where there is no threshold
  /// Predicted threshold in dB, the mean over the samples of noise; absent if the target is not
  /// seen at the largest contrast, or is seen at the lowest.
  std::optional<double> threshold_db;
  std::vector<double> samples_db;  ///< one per sample of noise
  int evaluations = 0;             ///< how often the model was asked
  double wall_s = 0.0;
  std::string started_utc;
  std::string machine;
};

/// "<experiment>.<stimulus>.<model>"
std::string cell_name(const PredictionRecord& record);

nlohmann::ordered_json to_json(const PredictionRecord& record);
/// @throws base::InputError naming the missing or mistyped field
PredictionRecord prediction_record_from_json(const nlohmann::ordered_json& json);

}  // namespace results::psychophysics
