#include "suites/command_line/diff_output.h"
#include "suites/command_line/viewing_arguments.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/run_record.h"
#include "suites/command_line/console.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

constexpr int kDigits = 6;

std::string value_text(double value) {
  if (std::isnan(value)) return "n/a";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{:.{}g}", value, kDigits);
}

ordered_json text_or_null(const std::string& text) {
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

ordered_json score_json(const DiffScore& entry) {
  const metrics::MetricInfo& info = *entry.choice->info;
  ordered_json details = ordered_json::object();
  for (const metrics::NamedValue& detail : entry.score.details) {
    details[detail.name] = detail.value;
  }
  ordered_json regions = ordered_json::array();
  for (const metrics::Region& r : entry.score.regions) {
    regions.push_back({{"x_px", r.x_px},
                       {"y_px", r.y_px},
                       {"width_px", r.width_px},
                       {"height_px", r.height_px},
                       {"value", r.value}});
  }
  return {{"value", entry.score.value},
          {"text", value_text(entry.score.value)},
          {"unit", info.unit},
          {"better", info.better == metrics::Better::lower ? "lower" : "higher"},
          {"version", info.version},
          {"parameters", entry.choice->parameters.to_json()},
          {"non_finite_pixels", entry.score.non_finite_pixels},
          {"details", std::move(details)},
          {"regions", std::move(regions)},
          {"map", text_or_null(entry.map)},
          {"map_picture", text_or_null(entry.map_picture)}};
}

ordered_json non_finite_json(const DiffImage& image) {
  if (image.non_finite.pixels == 0) return {{"pixels", 0}, {"first_px", nullptr}};
  return {{"pixels", image.non_finite.pixels},
          {"first_px", {image.non_finite.first_x_px, image.non_finite.first_y_px}}};
}

ordered_json channels_json(std::span<const float> channels) {
  ordered_json json = ordered_json::array();
  for (const float value : channels) json.push_back(value);
  return json;
}

/// Value of a score's map at a pixel of the whole image; NaN if it has no map.
double map_value(const DiffScore& entry, const PointPx& at, const RectanglePx& region) {
  if (!entry.score.map) return std::nan("");
  return entry.score.map->at(at.x - region.x, at.y - region.y);
}

ordered_json at_json(const DiffInputs& inputs, const DiffResult& result) {
  const PointPx& at = *inputs.at;
  const int x = at.x - inputs.region.x;
  const int y = at.y - inputs.region.y;
  ordered_json maps = ordered_json::object();
  for (const DiffScore& entry : result.scores) {
    maps[entry.choice->text] = map_value(entry, at, inputs.region);
  }
  return {{"x_px", at.x},
          {"y_px", at.y},
          {"reference", channels_json(inputs.reference.image.pixel(x, y))},
          {"test", channels_json(result.test.image.pixel(x, y))},
          {"maps", std::move(maps)}};
}

std::string reason_of(const DiffInputs& inputs, const DiffResult& result) {
  const bool is_reference = inputs.reference.non_finite.pixels > 0;
  const DiffImage& image = is_reference ? inputs.reference : result.test;
  return fmt::format("{} non-finite pixels in {}, the first at ({}, {})", image.non_finite.pixels,
                     image.path.string(), image.non_finite.first_x_px, image.non_finite.first_y_px);
}

/// The fields that each test has of its own.
void add_test(const DiffInputs& inputs, const DiffResult& result, ordered_json& json) {
  ordered_json scores = ordered_json::object();
  for (const DiffScore& entry : result.scores) scores[entry.choice->text] = score_json(entry);
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
  return {
      {"status", status},
      {"reason", status == "ok" ? ordered_json(nullptr) : ordered_json(reason_of(inputs, result))}};
}

void add_common(const DiffInputs& inputs, ordered_json& json) {
  json["size_px"] = {inputs.size_px.width, inputs.size_px.height};
  const RectanglePx& r = inputs.region;
  json["region_px"] = {r.x, r.y, r.width, r.height};
  json["viewing"] = perception::to_json(inputs.viewing);
}

/// What else the metrics say, a line each: "flip: weighted_median 0.31, ...".
std::string details_text(const DiffResult& result) {
  std::string text;
  for (const DiffScore& entry : result.scores) {
    std::string details;
    for (const metrics::NamedValue& detail : entry.score.details) {
      details += fmt::format("{} {} {}", details.empty() ? ":" : ",", detail.name,
                             value_text(detail.value));
    }
    if (!details.empty()) text += entry.choice->text + details + "\n";
  }
  return text;
}

std::string test_text(const DiffInputs& inputs, const DiffResult& result) {
  std::string text =
      fmt::format("{} against {}\n", result.test.path.string(), inputs.reference.path.string());
  std::vector<std::vector<std::string>> rows{{"metric", "value", "unit", "better"}};
  if (inputs.at) rows.front().push_back(fmt::format("map at {},{}", inputs.at->x, inputs.at->y));
  for (const DiffScore& entry : result.scores) {
    const metrics::MetricInfo& info = *entry.choice->info;
    rows.push_back({entry.choice->text, value_text(entry.score.value), info.unit,
                    info.better == metrics::Better::lower ? "lower" : "higher"});
    if (inputs.at) rows.back().push_back(value_text(map_value(entry, *inputs.at, inputs.region)));
  }
  text += text_table(rows) + details_text(result);
  if (inputs.at) {
    const ordered_json at = at_json(inputs, result);
    text += fmt::format("pixel {},{}: reference {}, test {}\n", inputs.at->x, inputs.at->y,
                        at["reference"].dump(), at["test"].dump());
  }
  for (const std::string& gate : result.violated_gates) text += "limit violated: " + gate + "\n";
  for (const DiffImage* image : {&inputs.reference, &result.test}) {
    if (image->non_finite.pixels == 0) continue;
    text += fmt::format("{}: {} non-finite pixels, the first at ({}, {})\n", image->path.string(),
                        image->non_finite.pixels, image->non_finite.first_x_px,
                        image->non_finite.first_y_px);
  }
  return text;
}

}  // namespace

std::string status_of(const DiffResult& result, bool ignores_non_finite) {
  const bool has_any =
      std::any_of(result.scores.begin(), result.scores.end(),
                  [](const DiffScore& entry) { return entry.score.non_finite_pixels > 0; });
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

std::string diff_text(const DiffInputs& inputs, const std::vector<DiffResult>& results) {
  std::string text = viewing_text(inputs.viewing);
  for (const DiffResult& result : results) text += "\n" + test_text(inputs, result);
  return text;
}

}  // namespace suites::command_line
