#include "results/psychophysics/prediction_record.h"

#include <nlohmann/json.hpp>

#include "results/json_fields.h"

namespace results::psychophysics {

using nlohmann::ordered_json;

std::string cell_name(const PredictionRecord& record) {
  return record.experiment + "." + record.stimulus + "." + record.model;
}

ordered_json to_json(const PredictionRecord& record) {
  ordered_json samples = ordered_json::array();
  for (const double sample : record.samples_db) samples.push_back(finite_or_null(sample));
  return {
      {"schema", kSchemaVersion},
      {"run", record.run},
      {"cell", cell_name(record)},
      {"experiment", record.experiment},
      {"stimulus", record.stimulus},
      {"model", record.model},
      {"status", results::to_string(record.status)},
      {"reason", record.reason ? ordered_json(*record.reason) : ordered_json()},
      {"threshold_db", record.threshold_db ? finite_or_null(*record.threshold_db) : ordered_json()},
      {"samples_db", std::move(samples)},
      {"evaluations", record.evaluations},
      {"wall_s", finite_or_null(record.wall_s)},
      {"started_utc", record.started_utc},
      {"machine", record.machine}};
}

PredictionRecord prediction_record_from_json(const ordered_json& json) {
  const JsonFields fields(json, "prediction");
  PredictionRecord record;
  record.run = fields.text("run");
  record.experiment = fields.text("experiment");
  record.stimulus = fields.text("stimulus");
  record.model = fields.text("model");
  record.status = status_from_text(fields.text("status"));
  record.reason = fields.optional_text("reason");
  record.threshold_db = fields.optional_number("threshold_db");
  for (const ordered_json& sample : fields.list("samples_db")) {
    if (!sample.is_number()) fields.fail("samples_db", "a list of numbers", sample);
    record.samples_db.push_back(sample.get<double>());
  }
  record.evaluations = static_cast<int>(fields.integer("evaluations"));
  record.wall_s = fields.number("wall_s");
  record.started_utc = fields.text("started_utc");
  record.machine = fields.text("machine");
  return record;
}

}  // namespace results::psychophysics
