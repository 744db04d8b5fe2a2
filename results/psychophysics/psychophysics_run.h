#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/psychophysics/experiment.h"
#include "results/psychophysics/prediction_record.h"

namespace results::psychophysics {

/// A model as the suite names it.
struct VisionModel {
  std::string id;       ///< with sweep values: "rama[csf_gain=0.5]"
  std::string kind;     ///< csf | pattern | metric | tvi
  std::string summary;  ///< "visible-difference,masking=joint: jnd_max at 1"
};

/// Everything stored about a run of kind psychophysics.
struct PsychophysicsRun {
  std::filesystem::path folder;
  std::shared_ptr<const nlohmann::ordered_json> info;  ///< run.json, never null
  std::string resolved_suite;                          ///< suite.resolved.yaml
  std::vector<Experiment> experiments;
  std::vector<VisionModel> models;
  /// In the order they were made; the last one of each (experiment, stimulus, model) wins.
  std::vector<PredictionRecord> predictions;
  std::size_t unreadable_lines = 0;  ///< a line cut by a crash is skipped and counted

  /// Null if there is none (yet).
  const PredictionRecord* find(const std::string& experiment, const std::string& stimulus,
                               const std::string& model) const;
};

/// Reads a run; works while it is still being written.
/// @throws base::InputError if the folder is no run of this kind
PsychophysicsRun load_psychophysics_run(const std::filesystem::path& folder);

}  // namespace results::psychophysics
