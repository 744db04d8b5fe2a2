#include "suites/command_line/diff_output.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/run_record.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

constexpr int kDigits = 6;

ordered_json text_or_null(const std::string& text) {
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

ordered_json details_json(const metrics::Score& score) {
  ordered_json details = ordered_json::object();
  for (const metrics::NamedValue& detail : score.details) details[detail.name] = detail.value;
  return details;
}

ordered_json regions_json(const metrics::Score& score) {
  ordered_json regions = ordered_json::array();
  for (const metrics::Region& r : score.regions) {
    regions.push_back({{"x_px", r.x_px},
                       {"y_px", r.y_px},
                       {"width_px", r.width_px},
                       {"height_px", r.height_px},
                       {"value", r.value}});
  }
  return regions;
}

/// The fields that scores of images and of single frames of a sequence share.
void add_values(const MappedScore& entry, ordered_json& json) {
  json["non_finite_pixels"] = entry.score.non_finite_pixels;
  json["details"] = details_json(entry.score);
  json["regions"] = regions_json(entry.score);
  json["map"] = text_or_null(entry.map);
  json["map_picture"] = text_or_null(entry.map_picture);
}

ordered_json score_json(const DiffScore& score) {
  const metrics::MetricDescription& info = description_of(*score.choice);
  ordered_json json{{"value", score.entry.score.value},
                    {"text", value_text(score.entry.score.value)},
                    {"unit", info.unit},
                    {"better", info.better == metrics::Better::lower ? "lower" : "higher"},
                    {"version", info.version},
                    {"parameters", score.parameters.to_json()}};
  add_values(score.entry, json);
  if (score.frames.empty()) return json;
  json["frames"] = ordered_json::array();
  for (const DiffFrame& frame : score.frames) {
    ordered_json entry{{"frame", frame.frame},
                       {"value", frame.entry.score.value},
                       {"text", value_text(frame.entry.score.value)}};
    add_values(frame.entry, entry);
    json["frames"].push_back(std::move(entry));
  }
  return json;
}

ordered_json non_finite_json(const DiffImage& image) {
  ordered_json json{{"pixels", image.non_finite.pixels}, {"first_px", nullptr}};
  if (image.non_finite.pixels > 0) {
    json["first_px"] = {image.non_finite.first_x_px, image.non_finite.first_y_px};
  }
  if (image.first_non_finite_frame) json["first_frame"] = *image.first_non_finite_frame;
  return json;
}

ordered_json channels_json(std::span<const float> channels) {
  ordered_json json = ordered_json::array();
  for (const float value : channels) json.push_back(value);
  return json;
}

ordered_json at_json(const DiffInputs& inputs, const DiffResult& result) {
  const PointPx& at = *inputs.at;
  const int x = at.x - inputs.region.x;
  const int y = at.y - inputs.region.y;
  ordered_json maps = ordered_json::object();
  for (const DiffScore& score : result.scores) {
    maps[text_of(*score.choice)] = map_value(score, inputs);
  }
  return {{"x_px", at.x},
          {"y_px", at.y},
          {"reference", channels_json(inputs.reference.image.pixel(x, y))},
          {"test", channels_json(result.test.image.pixel(x, y))},
          {"maps", std::move(maps)}};
}

/// The fields that each test has of its own.
void add_test(const DiffInputs& inputs, const DiffResult& result, ordered_json& json) {
  ordered_json scores = ordered_json::object();
  for (const DiffScore& score : result.scores) scores[text_of(*score.choice)] = score_json(score);
  json["scores"] = std::move(scores);
  json["non_finite"] = {{"reference", non_finite_json(inputs.reference)},
                        {"test", non_finite_json(result.test)}};
  json["violated"] = result.violated_gates;
  if (inputs.at) json["at"] = at_json(inputs, result);
  json["notes"] = result.test.notes;
}

ordered_json status_json(const DiffInputs& inputs, const DiffResult& result,
                         bool ignores_non_finite) {
  const std::string status = status_of(result, ignores_non_finite);
  const bool is_reference = inputs.reference.non_finite.pixels > 0;
  const DiffImage& image = is_reference ? inputs.reference : result.test;
  return {
      {"status", status},
      {"reason", status == "ok" ? ordered_json(nullptr) : ordered_json(non_finite_text(image))}};
}

void add_common(const DiffInputs& inputs, ordered_json& json) {
  json["size_px"] = {inputs.size_px.width, inputs.size_px.height};
  const RectanglePx& r = inputs.region;
  json["region_px"] = {r.x, r.y, r.width, r.height};
  json["viewing"] = perception::to_json(inputs.viewing);
  if (!inputs.frames.empty()) json["frames"] = inputs.frames;
}

}  // namespace

std::string value_text(double value) {
  if (std::isnan(value)) return "n/a";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{:.{}g}", value, kDigits);
}

double map_value(const DiffScore& score, const DiffInputs& inputs) {
  if (!score.entry.score.map) return std::nan("");
  return score.entry.score.map->at(inputs.at->x - inputs.region.x, inputs.at->y - inputs.region.y);
}

std::string non_finite_text(const DiffImage& image) {
  const std::string frame = image.first_non_finite_frame
                                ? fmt::format("in frame {} ", *image.first_non_finite_frame)
                                : std::string();
  return fmt::format("{} non-finite pixels in {}, the first {}at ({}, {})", image.non_finite.pixels,
                     image.path.string(), frame, image.non_finite.first_x_px,
                     image.non_finite.first_y_px);
}

std::string status_of(const DiffResult& result, bool ignores_non_finite) {
  const bool has_any =
      std::any_of(result.scores.begin(), result.scores.end(),
                  [](const DiffScore& score) { return score.entry.score.non_finite_pixels > 0; });
  return has_any && !ignores_non_finite ? "non_finite" : "ok";
}

ordered_json diff_json(const DiffInputs& inputs, const std::vector<DiffResult>& results,
                       bool ignores_non_finite) {
  ordered_json json{{"schema", results::kSchemaVersion}};
  const auto failed = std::find_if(results.begin(), results.end(), [&](const DiffResult& result) {
    return status_of(result, ignores_non_finite) != "ok";
  });
  json.update(
      status_json(inputs, failed == results.end() ? results.front() : *failed, ignores_non_finite));
  json["reference"] = inputs.reference.path.string();
  if (results.size() == 1) {
    json["test"] = results.front().test.path.string();
    add_common(inputs, json);
    add_test(inputs, results.front(), json);
    return json;
  }
  add_common(inputs, json);
  json["tests"] = ordered_json::array();
  for (const DiffResult& result : results) {
    ordered_json test{{"test", result.test.path.string()}};
    test.update(status_json(inputs, result, ignores_non_finite));
    add_test(inputs, result, test);
    json["tests"].push_back(std::move(test));
  }
  return json;
}

}  // namespace suites::command_line
