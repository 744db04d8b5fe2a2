#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/parameter_spec.h"
#include "results/json_fields.h"
#include "results/record_values.h"
#include "results/run_record.h"

namespace results {

using nlohmann::ordered_json;

ordered_json parameters_json(const ParameterValues& parameters) {
  ordered_json json = ordered_json::object();
  for (const auto& [name, value] : parameters) json[name] = base::to_json(value);
  return json;
}

std::optional<base::ParameterValue> parameter_from_json(const ordered_json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  return std::nullopt;
}

ParameterValues parameters_of(const JsonFields& fields, const char* key) {
  ParameterValues parameters;
  for (const auto& [name, value] : fields.object(key).items()) {
    auto parameter = parameter_from_json(value);
    if (!parameter) {
      fields.fail(fmt::format("{}.{}", key, name), "a boolean, a number or text", value);
    }
    parameters.emplace_back(name, std::move(*parameter));
  }
  return parameters;
}

ordered_json to_json(const CellRecord& record) {
  ordered_json json;
  json["schema"] = kSchemaVersion;
  json["run"] = record.run;
  json["cell"] = record.cell;
  json["scene"] = record.scene;
  json["method"] = record.method;
  json["budget"] = record.budget;
  json["profile"] = record.profile;
  json["repetition"] = record.repetition;
  json["started_utc"] = record.started_utc;
  json["machine"] = record.machine;
  json["canary_s"] = record.canary_s ? finite_or_null(*record.canary_s) : ordered_json(nullptr);
  json["jobs"] = record.jobs;
  write_fields(record.render, false, json);
  json["checkpoints"] = ordered_json::array();
  for (const Checkpoint& checkpoint : record.checkpoints) {
    ordered_json entry;
    entry["s"] = finite_or_null(checkpoint.elapsed_s);
    entry["samples"] = checkpoint.samples;
    entry["image"] = checkpoint.image;
    json["checkpoints"].push_back(std::move(entry));
  }
  return json;
}

CellRecord cell_record_from_json(const ordered_json& json) {
  const JsonFields fields(json, "cell record");
  CellRecord record;
  record.run = fields.text("run");
  record.cell = fields.text("cell");
  record.scene = fields.text("scene");
  record.method = fields.text("method");
  record.budget = fields.text("budget");
  record.profile = fields.text("profile");
  record.repetition = static_cast<int>(fields.integer("repetition"));
  record.started_utc = fields.text("started_utc");
  record.machine = fields.text("machine");
  record.canary_s = fields.optional_number("canary_s");
  record.jobs = static_cast<int>(fields.optional_integer("jobs").value_or(1));
  record.render = read_render_fields(fields);
  const ordered_json& checkpoints = fields.list("checkpoints");
  for (std::size_t i = 0; i < checkpoints.size(); ++i) {
    const JsonFields entry(checkpoints[i], fmt::format("cell record: checkpoints[{}]", i));
    record.checkpoints.push_back(
        {entry.number("s"), entry.integer("samples"), entry.text("image")});
  }
  return record;
}

ordered_json to_json(const MetricRecord& record) {
  ordered_json json;
  json["schema"] = kSchemaVersion;
  json["cell"] = record.cell;
  json["frame"] = record.frame;
  json["against"] = record.against;
  json["image_hash"] = record.image_hash;
  json["reference_hash"] = record.reference_hash;
  json["metric"] = record.metric;
  json["parameters"] = parameters_json(record.parameters);
  json["version"] = record.version;
  json["viewing_hash"] = record.viewing_hash;
  json["value"] = record.value ? finite_or_null(*record.value) : ordered_json(nullptr);
  json["infinite"] = record.is_infinite || record.value == std::numeric_limits<double>::infinity();
  json["details"] = ordered_json::object();
  for (const auto& [name, value] : record.details) json["details"][name] = finite_or_null(value);
  json["map"] = record.map.empty() ? ordered_json(nullptr) : ordered_json(record.map);
  json["noise_floor"] =
      record.noise_floor ? finite_or_null(*record.noise_floor) : ordered_json(nullptr);
  json["reference_pixel_hash"] = record.reference_pixel_hash;
  json["context_hash"] = record.context_hash;
  const auto text_or_null = [](const std::string& text) {
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
  };
  json["id"] = text_or_null(record.id);
  json["image"] = text_or_null(record.image);
  json["mask"] = text_or_null(record.mask);
  json["mask_hash"] = text_or_null(record.mask_hash);
  return json;
}

MetricRecord metric_record_from_json(const ordered_json& json) {
  const JsonFields fields(json, "metric record");
  MetricRecord record;
  record.cell = fields.text("cell");
  record.frame = static_cast<int>(fields.integer("frame"));
  record.against = fields.text("against");
  if (record.against != "own" && record.against != "full") {
    fields.fail("against", "own or full", fields.require("against"));
  }
  record.image_hash = fields.text("image_hash");
  record.reference_hash = fields.text("reference_hash");
  record.metric = fields.text("metric");
  record.parameters = parameters_of(fields, "parameters");
  record.version = static_cast<int>(fields.integer("version"));
  record.viewing_hash = fields.text("viewing_hash");
  record.value = fields.optional_number("value");
  record.is_infinite = fields.flag("infinite");
  const JsonFields details(fields.object("details"), "metric record: details");
  for (const auto& [name, value] : fields.object("details").items()) {
    record.details.emplace_back(name, details.number(name.c_str()));
  }
  record.map = fields.optional_text("map").value_or("");
  record.noise_floor = fields.optional_number("noise_floor");
  record.reference_pixel_hash = fields.optional_text("reference_pixel_hash").value_or("");
  record.context_hash = fields.optional_text("context_hash").value_or("");
  record.id = fields.optional_text("id").value_or("");
  record.image = fields.optional_text("image").value_or("");
  record.mask = fields.optional_text("mask").value_or("");
  record.mask_hash = fields.optional_text("mask_hash").value_or("");
  return record;
}

ordered_json to_json(const CheckpointScore& record) {
  ordered_json json = to_json(record.score);
  json["checkpoint"] = record.checkpoint;
  json["samples"] = record.samples;
  json["s"] = finite_or_null(record.elapsed_s);
  return json;
}

CheckpointScore checkpoint_score_from_json(const ordered_json& json) {
  const JsonFields fields(json, "checkpoint score");
  CheckpointScore record;
  record.score = metric_record_from_json(json);
  record.checkpoint = static_cast<int>(fields.integer("checkpoint"));
  record.samples = fields.integer("samples");
  record.elapsed_s = fields.number("s");
  return record;
}

}  // namespace results
