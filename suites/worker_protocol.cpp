#include "suites/worker_protocol.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"

namespace suites {
namespace {

using Json = nlohmann::ordered_json;

Json parameters_to_json(const results::ParameterValues& parameters) {
  Json json = Json::object();
  for (const auto& [name, value] : parameters) json[name] = base::to_json(value);
  return json;
}

base::ParameterValue value_from_json(const Json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  return json.get<std::string>();
}

template <typename T>
Json nullable(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

template <typename T>
std::optional<T> optional_from(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return json.get<T>();
}

Json json_of(const OpenJob& job) {
  Json overlays = Json::array();
  for (const base::Node& overlay : job.scene_overlays) overlays.push_back(overlay.to_json());
  return Json{{"job", "open"},
              {"scene_file", job.scene_file.string()},
              {"scene_overlays", std::move(overlays)},
              {"frame", job.frame},
              {"sequence", job.is_sequence},
              {"size_px", {job.size_px.width, job.size_px.height}},
              {"renderer", job.renderer},
              {"preset", job.preset},
              {"parameters", parameters_to_json(job.parameters)},
              {"threads", job.threads},
              {"platform", job.platform},
              {"warmups", job.warmups}};
}

Json json_of(const RenderOrder& order) {
  return Json{{"job", "render"},
              {"repetition", order.repetition},
              {"frame", order.frame},
              {"cold", order.is_cold},
              {"last", order.is_last},
              {"new_view", order.has_new_view},
              {"seed", order.seed},
              {"samples", nullable(order.samples)},
              {"time_s", nullable(order.time_s)},
              {"settings", parameters_to_json(order.settings)},
              {"image", order.image.string()},
              {"checkpoint_folder", order.checkpoint_folder.string()},
              {"known_pixel_hash", order.known_pixel_hash}};
}

Json json_of(const CloseJob&) { return Json{{"job", "close"}}; }

Json json_of(const Opened& opened) {
  return Json{
      {"reply", "opened"}, {"start_up_s", opened.start_up_s}, {"scene_hash", opened.scene_hash}};
}

Json json_of(const Rendered& rendered) {
  Json checkpoints = Json::array();
  for (const results::Checkpoint& checkpoint : rendered.checkpoints) {
    checkpoints.push_back(Json{
        {"s", checkpoint.elapsed_s}, {"samples", checkpoint.samples}, {"image", checkpoint.image}});
  }
  return Json{{"reply", "rendered"},
              {"record", results::to_json(rendered.record)},
              {"checkpoints", std::move(checkpoints)}};
}

Json json_of(const Refused& refused) {
  return Json{{"reply", "refused"}, {"reason", refused.reason}};
}

Json json_of(const NotStored& not_stored) {
  return Json{{"reply", "not_stored"}, {"reason", not_stored.reason}};
}

results::ParameterValues parameters_from(const Json& json) {
  results::ParameterValues parameters;
  for (const auto& [name, value] : json.items()) {
    parameters.emplace_back(name, value_from_json(value));
  }
  return parameters;
}

OpenJob open_job_from(const Json& json) {
  OpenJob job;
  job.scene_file = json.at("scene_file").get<std::string>();
  for (const Json& overlay : json.at("scene_overlays")) {
    job.scene_overlays.push_back(base::parse_document(overlay.dump(), "worker job"));
  }
  job.frame = json.at("frame").get<int>();
  job.is_sequence = json.at("sequence").get<bool>();
  job.size_px = {json.at("size_px").at(0).get<int>(), json.at("size_px").at(1).get<int>()};
  job.renderer = json.at("renderer").get<std::string>();
  job.preset = json.at("preset").get<std::string>();
  job.parameters = parameters_from(json.at("parameters"));
  job.threads = json.at("threads").get<int>();
  job.platform = json.at("platform").get<std::string>();
  job.warmups = json.at("warmups").get<int>();
  return job;
}

RenderOrder render_order_from(const Json& json) {
  RenderOrder order;
  order.repetition = json.at("repetition").get<int>();
  order.frame = json.at("frame").get<int>();
  order.is_cold = json.at("cold").get<bool>();
  order.is_last = json.at("last").get<bool>();
  order.has_new_view = json.at("new_view").get<bool>();
  order.seed = json.at("seed").get<std::uint64_t>();
  order.samples = optional_from<std::int64_t>(json.at("samples"));
  order.time_s = optional_from<double>(json.at("time_s"));
  order.settings = parameters_from(json.at("settings"));
  order.image = json.at("image").get<std::string>();
  order.checkpoint_folder = json.at("checkpoint_folder").get<std::string>();
  order.known_pixel_hash = json.at("known_pixel_hash").get<std::string>();
  return order;
}

Rendered rendered_from(const Json& json) {
  Rendered rendered;
  rendered.record = results::render_record_from_json(nlohmann::json(json.at("record")));
  for (const Json& item : json.at("checkpoints")) {
    rendered.checkpoints.push_back({item.at("s").get<double>(),
                                    item.at("samples").get<std::int64_t>(),
                                    item.at("image").get<std::string>()});
  }
  return rendered;
}

/// Parses a line and hands it to a reader; what nlohmann reports becomes an InputError.
template <typename Read>
auto read_line(const std::string& line, const char* what, const Read& read) {
  try {
    return read(Json::parse(line));
  } catch (const nlohmann::json::exception& error) {
    throw base::InputError(fmt::format("not a {} of the worker protocol: {}: {}", what,
                                       error.what(), line.substr(0, 200)));
  }
}

}  // namespace

std::string to_line(const Job& job) {
  return std::visit([](const auto& held) { return json_of(held).dump(); }, job);
}

std::string to_line(const Reply& reply) {
  return std::visit([](const auto& held) { return json_of(held).dump(); }, reply);
}

Job job_from_line(const std::string& line) {
  return read_line(line, "job", [](const Json& json) -> Job {
    const std::string kind = json.at("job").get<std::string>();
    if (kind == "open") return open_job_from(json);
    if (kind == "render") return render_order_from(json);
    if (kind == "close") return CloseJob{};
    const std::vector<std::string> known{"open", "render", "close"};
    throw base::InputError(base::unknown_name("job", kind, known));
  });
}

Reply reply_from_line(const std::string& line) {
  return read_line(line, "reply", [](const Json& json) -> Reply {
    const std::string kind = json.at("reply").get<std::string>();
    if (kind == "opened") {
      return Opened{json.at("start_up_s").get<double>(), json.at("scene_hash").get<std::string>()};
    }
    if (kind == "rendered") return rendered_from(json);
    if (kind == "refused") return Refused{json.at("reason").get<std::string>()};
    if (kind == "not_stored") return NotStored{json.at("reason").get<std::string>()};
    const std::vector<std::string> known{"opened", "rendered", "refused", "not_stored"};
    throw base::InputError(base::unknown_name("reply", kind, known));
  });
}

}  // namespace suites
