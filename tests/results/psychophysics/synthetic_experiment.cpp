#include "tests/results/psychophysics/synthetic_experiment.h"

#include <nlohmann/json.hpp>

namespace tests {

using namespace results::psychophysics;

PredictionRecord prediction(const std::string& stimulus, const std::string& model, double db) {
  PredictionRecord record;
  record.run = "20260101T000000Z-000001";
  record.experiment = "edges";
  record.stimulus = stimulus;
  record.model = model;
  record.threshold_db = db;
  record.samples_db = {db};
  record.evaluations = 1;
  record.wall_s = 0.5;
  record.started_utc = "2026-01-01T00:00:00Z";
  record.machine = "tests";
  return record;
}

PsychophysicsRun synthetic_experiment(const std::filesystem::path& folder) {
  Experiment experiment;
  experiment.id = "edges";
  experiment.summary = "Edges <sharp> & soft.";
  experiment.source = "tests";
  experiment.axis = {"pedestal contrast", "%"};
  // Thresholds grow by 12 dB per decade: slope 0.6.
  experiment.stimuli = {
      {"p1", "one", "", 1.0, 100.0, -40.0, 2.0, "", Half::calibration, ""},
      {"p10", "ten", "", 10.0, 100.0, -28.0, {}, "", Half::held_out, ""},
      {"p100", "hundred", "", 100.0, 100.0, -16.0, {}, "", Half::calibration, ""},
      {"noisy", "in noise", "noise", 20.0, 100.0, 10.0, {}, "p1", Half::held_out, ""}};
  experiment.phenomena = {
      {PhenomenonKind::slope, "slope", "grows as a power", {"p1", "p10", "p100"}, false, 0.5, 0.7},
      {PhenomenonKind::lower, "order", "one is below ten", {"p1", "p10"}, false, 3.0, 0.0},
      {PhenomenonKind::ranking, "ranks", "in order", {"p1", "p10", "p100"}, false, 0.9, 0.0},
      {PhenomenonKind::within, "factor", "within 1.5", {"p1", "noisy"}, false, 1.0, 0.0, 1.5}};
  PsychophysicsRun run;
  run.folder = folder;
  run.info = std::make_shared<const nlohmann::ordered_json>(
      nlohmann::ordered_json{{"schema", 1},
                             {"kind", "psychophysics"},
                             {"suite", "edges"},
                             {"run", "20260101T000000Z-000001"},
                             {"summary", "A test."},
                             {"state", "complete"},
                             {"planned_questions", 12},
                             {"command", "discern run tests"}});
  run.resolved_suite = "{}";
  run.experiments = {experiment};
  run.models = {{"exact", "csf", "what people say"},
                {"lax", "metric", "6 dB more"},
                {"silent", "tvi", "nothing"}};
  run.predictions = {prediction("p1", "exact", -40.0),   prediction("p10", "exact", -28.0),
                     prediction("p100", "exact", -16.0), prediction("noisy", "exact", -30.0),
                     prediction("p1", "lax", -34.0),     prediction("p10", "lax", -22.0),
                     prediction("p100", "lax", -10.0),   prediction("noisy", "lax", -27.0)};
  for (const char* stimulus : {"p1", "p10", "p100", "noisy"}) {
    PredictionRecord silent = prediction(stimulus, "silent", 0.0);
    silent.threshold_db.reset();
    silent.samples_db.clear();
    silent.status = results::Status::unsupported;
    silent.reason = "TVI knows spots on plain fields only";
    run.predictions.push_back(silent);
  }
  return run;
}

}  // namespace tests
