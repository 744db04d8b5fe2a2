#include "results/psychophysics/psychophysics_run.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "results/json_fields.h"
#include "results/result_store.h"
#include "results/run_files.h"

namespace results::psychophysics {

using nlohmann::ordered_json;

const PredictionRecord* PsychophysicsRun::find(const std::string& experiment,
                                               const std::string& stimulus,
                                               const std::string& model) const {
  const auto found = std::find_if(predictions.begin(), predictions.end(), [&](const auto& record) {
    return record.experiment == experiment && record.stimulus == stimulus && record.model == model;
  });
  return found == predictions.end() ? nullptr : &*found;
}

PsychophysicsRun load_psychophysics_run(const std::filesystem::path& folder) {
  if (const std::string kind = run_kind(folder); kind != "psychophysics") {
    throw base::InputError(
        fmt::format("{}: a run of kind {}; accepted here: psychophysics", folder.string(), kind));
  }
  PsychophysicsRun run;
  run.folder = folder;
  run.info = std::make_shared<const ordered_json>(read_run_json(folder));
  run.resolved_suite = text_or_empty(folder / "suite.resolved.yaml");
  const JsonFields fields(*run.info, "run.json");
  for (const ordered_json& experiment : fields.list("experiments")) {
    run.experiments.push_back(experiment_from_json(experiment));
  }
  for (const ordered_json& model : fields.list("models")) {
    const JsonFields entry(model, "model");
    run.models.push_back({entry.text("id"), entry.text("kind"), entry.text("summary")});
  }
  LastOfEachKey<PredictionRecord, std::string> predictions(run.predictions);
  run.unreadable_lines = read_lines(folder / "cells.jsonl", [&](const ordered_json& json) {
    PredictionRecord record = prediction_record_from_json(json);
    const std::string key = cell_name(record);
    predictions.add(key, std::move(record));
  });
  return run;
}

}  // namespace results::psychophysics
