#include "results/run_record.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "results/json_fields.h"
#include "results/record_values.h"

namespace results {

using nlohmann::ordered_json;

namespace {

constexpr std::array<const char*, 9> kStatusNames{"ok",       "cached",        "timeout",
                                                  "crash",    "out_of_memory", "non_finite",
                                                  "diverged", "unsupported",   "skipped"};

/// Whole counters are written without a fraction ("rays":1024); beyond 2^53 doubles skip numbers.
ordered_json counter_number(double value) {
  constexpr double kExactIntegers = 9007199254740992.0;
  if (std::isfinite(value) && std::trunc(value) == value && std::abs(value) <= kExactIntegers) {
    return static_cast<std::int64_t>(value);
  }
  return finite_or_null(value);
}

ordered_json counters_json(const RenderRecord& record) {
  ordered_json counters = ordered_json::object();
  for (const auto& [name, value] : record.counters) {
    if (const double* number = std::get_if<double>(&value)) {
      counters[name] = counter_number(*number);
      continue;
    }
    ordered_json series = ordered_json::array();
    for (const double number : std::get<std::vector<double>>(value)) {
      series.push_back(counter_number(number));
    }
    counters[name] = std::move(series);
  }
  return counters;
}

double number_of(const JsonFields& fields, const std::string& name, const ordered_json& json) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!json.is_number()) fields.fail(name, "a number, null, or a list of them", json);
  return json.get<double>();
}

std::vector<std::pair<std::string, renderers::CounterValue>> counters_of(const JsonFields& fields) {
  std::vector<std::pair<std::string, renderers::CounterValue>> counters;
  for (const auto& [name, json] : fields.object("counters").items()) {
    const std::string field = "counters." + name;
    if (!json.is_array()) {
      counters.emplace_back(name, number_of(fields, field, json));
      continue;
    }
    std::vector<double> series;
    for (const ordered_json& number : json) series.push_back(number_of(fields, field, number));
    counters.emplace_back(name, std::move(series));
  }
  return counters;
}

ordered_json seconds_or_null(const std::optional<double>& seconds) {
  return seconds ? finite_or_null(*seconds) : ordered_json(nullptr);
}

ordered_json stage_json(const renderers::StageRecord& stage) {
  ordered_json json;
  json["phase"] = renderers::to_string(stage.phase);
  json["path"] = stage.path;
  json["wall_s"] = finite_or_null(stage.wall_s);
  json["cpu_s"] = finite_or_null(stage.cpu_s);
  json["gpu_s"] = stage.gpu_s < 0.0 ? ordered_json(nullptr) : finite_or_null(stage.gpu_s);
  json["clock"] = renderers::to_string(stage.clock);
  json["calls"] = stage.calls;
  json["bytes_cpu"] = stage.bytes_cpu;
  json["bytes_gpu"] = stage.bytes_gpu;
  return json;
}

renderers::Phase phase_of(const JsonFields& fields) {
  using renderers::Phase;
  const std::string text = fields.text("phase");
  for (const Phase phase : {Phase::prepare, Phase::update, Phase::render, Phase::new_view}) {
    if (renderers::to_string(phase) == text) return phase;
  }
  fields.fail("phase", "one of prepare, update, render, new_view", fields.require("phase"));
}

renderers::StageClock clock_of(const JsonFields& fields) {
  using renderers::StageClock;
  const std::string text = fields.text("clock");
  for (const StageClock clock : {StageClock::steady, StageClock::finish, StageClock::gpu_query}) {
    if (renderers::to_string(clock) == text) return clock;
  }
  fields.fail("clock", "one of steady, finish, gpu-query", fields.require("clock"));
}

renderers::StageRecord stage_of(const ordered_json& json, const std::string& what) {
  const JsonFields fields(json, what);
  renderers::StageRecord stage;
  stage.phase = phase_of(fields);
  stage.path = fields.text("path");
  stage.wall_s = fields.number("wall_s");
  stage.cpu_s = fields.number("cpu_s");
  stage.gpu_s = fields.optional_number("gpu_s").value_or(-1.0);
  stage.clock = clock_of(fields);
  stage.calls = fields.integer("calls");
  stage.bytes_cpu = fields.integer("bytes_cpu");
  stage.bytes_gpu = fields.integer("bytes_gpu");
  return stage;
}

void write_identity(const RenderRecord& record, ordered_json& json) {
  json["scene_hash"] = record.scene_hash;
  json["renderer"] = record.renderer;
  json["preset"] = record.preset;
  json["parameters"] = parameters_json(record.parameters);
  json["transport"] = record.transport;
  json["part"] = record.part;
  json["geometry_clamp"] = json_or_null(record.geometry_clamp);
  json["size_px"] = {record.width_px, record.height_px};
  json["seed"] = record.seed;
  json["frame"] = record.frame;
  json["samples"] = json_or_null(record.samples);
  json["device"] = record.device;
  json["gl_platform"] = json_or_null(record.gl_platform);
  json["threads"] = record.threads;
}

void write_measured(const RenderRecord& record, ordered_json& json) {
  json["total_s"] = finite_or_null(record.total_s);
  json["next_frame_s"] = seconds_or_null(record.next_frame_s);
  json["new_view_s"] = seconds_or_null(record.new_view_s);
  json["prepare_s"] = finite_or_null(record.prepare_s);
  json["update_s"] = seconds_or_null(record.update_s);
  json["render_s"] = finite_or_null(record.render_s);
  json["start_up_s"] = finite_or_null(record.start_up_s);
  json["readback_s"] = finite_or_null(record.readback_s);
  json["stages"] = ordered_json::array();
  for (const renderers::StageRecord& stage : record.stages) {
    json["stages"].push_back(stage_json(stage));
  }
  json["unattributed_s"] = finite_or_null(record.unattributed_s);
  json["counters"] = counters_json(record);
  json["peak_memory_bytes"] = record.peak_memory_bytes;
  json["non_finite_pixels"] = record.non_finite_pixels;
  json["pixel_hash"] = record.pixel_hash;
  json["image"] = record.image.empty() ? ordered_json(nullptr) : ordered_json(record.image);
  json["notes"] = record.notes;
}

void read_identity(const JsonFields& fields, RenderRecord& record) {
  const std::string status = fields.text("status");
  try {
    record.status = status_from_text(status);
  } catch (const base::InputError& error) {
    throw base::InputError(fmt::format("{}: field \"status\": {}", fields.what(), error.what()));
  }
  record.reason = fields.optional_text("reason");
  record.scene = fields.text("scene");
  record.scene_hash = fields.text("scene_hash");
  record.renderer = fields.text("renderer");
  record.preset = fields.text("preset");
  record.parameters = parameters_of(fields, "parameters");
  record.transport = fields.text("transport");
  record.part = fields.text("part");
  record.geometry_clamp = fields.optional_number("geometry_clamp");
  const ordered_json& size = fields.list("size_px");
  if (size.size() != 2 || !size[0].is_number_integer() || !size[1].is_number_integer()) {
    fields.fail("size_px", "[width, height]", size);
  }
  record.width_px = size[0].get<int>();
  record.height_px = size[1].get<int>();
  record.seed = fields.unsigned_integer("seed");
  record.frame = static_cast<int>(fields.integer("frame"));
  record.samples = fields.optional_integer("samples");
  record.device = fields.text("device");
  record.gl_platform = fields.optional_text("gl_platform");
  record.threads = static_cast<int>(fields.integer("threads"));
}

void read_measured(const JsonFields& fields, RenderRecord& record) {
  record.total_s = fields.number("total_s");
  record.next_frame_s = fields.optional_number("next_frame_s");
  record.new_view_s = fields.optional_number("new_view_s");
  record.prepare_s = fields.number("prepare_s");
  record.update_s = fields.optional_number("update_s");
  record.render_s = fields.number("render_s");
  record.start_up_s = fields.number("start_up_s");
  record.readback_s = fields.number("readback_s");
  const ordered_json& stages = fields.list("stages");
  for (std::size_t i = 0; i < stages.size(); ++i) {
    record.stages.push_back(stage_of(stages[i], fmt::format("{}: stages[{}]", fields.what(), i)));
  }
  record.unattributed_s = fields.number("unattributed_s");
  record.counters = counters_of(fields);
  record.peak_memory_bytes = fields.integer("peak_memory_bytes");
  record.non_finite_pixels = fields.unsigned_integer("non_finite_pixels");
  record.pixel_hash = fields.text("pixel_hash");
  record.image = fields.optional_text("image").value_or("");
  for (const ordered_json& note : fields.list("notes")) {
    if (!note.is_string()) fields.fail("notes", "a list of texts", note);
    record.notes.push_back(note.get<std::string>());
  }
}

}  // namespace

std::string to_string(Status status) { return kStatusNames[static_cast<std::size_t>(status)]; }

Status status_from_text(const std::string& text) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (base::is_same_name(kStatusNames[i], text)) return static_cast<Status>(i);
  }
  const std::vector<std::string> known(kStatusNames.begin(), kStatusNames.end());
  throw base::InputError(base::unknown_name("status", text, known));
}

bool is_success(Status status) { return status == Status::ok || status == Status::cached; }

bool is_failure(Status status) {
  return !is_success(status) && status != Status::unsupported && status != Status::skipped;
}

double timed_s(const RenderRecord& record) { return record.next_frame_s.value_or(record.total_s); }

void write_fields(const RenderRecord& record, bool with_scene, ordered_json& json) {
  json["status"] = to_string(record.status);
  json["reason"] = json_or_null(record.reason);
  if (with_scene) json["scene"] = record.scene;
  write_identity(record, json);
  write_measured(record, json);
}

RenderRecord read_render_fields(const JsonFields& fields) {
  RenderRecord record;
  read_identity(fields, record);
  read_measured(fields, record);
  return record;
}

ordered_json to_json(const RenderRecord& record) {
  ordered_json json;
  json["schema"] = kSchemaVersion;
  write_fields(record, true, json);
  return json;
}

RenderRecord render_record_from_json(const ordered_json& json) {
  return read_render_fields(JsonFields(json, "render record"));
}

}  // namespace results
