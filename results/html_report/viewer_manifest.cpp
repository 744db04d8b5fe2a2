#include "results/html_report/viewer_manifest.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "metrics/metric_list.h"
#include "perception/base/code_points.h"
#include "perception/false_color.h"
#include "results/html_report/html_text.h"
#include "results/json_fields.h"

namespace results::html_report {

using nlohmann::ordered_json;

namespace {

/// The colours of maps as sRGB bytes, at the anchors that false_color interpolates.
ordered_json color_list() {
  constexpr int kLast = 32;
  ordered_json colors = ordered_json::array();
  for (int i = 0; i <= kLast; ++i) {
    ordered_json color = ordered_json::array();
    for (const float part : perception::false_color(static_cast<double>(i) / kLast)) {
      color.push_back(std::round(25500.0F * part) / 100.0F);
    }
    colors.push_back(std::move(color));
  }
  return colors;
}

ordered_json scale_json(perception::MapScale scale, const std::string& unit) {
  if (scale.unit.empty()) scale.unit = unit;
  return {{"low", scale.low},
          {"high", scale.high},
          {"logarithmic", scale.is_logarithmic},
          {"unit", scale.unit}};
}

ordered_json metric_scale(const std::string& metric) {
  const metrics::MetricDescription* info = metric_info_of(metric);
  return scale_json(info->map_scale, info->map_unit);
}

/// The differences that the viewer makes itself, on the scales of the metrics that pool them.
ordered_json difference_scales() {
  const ordered_json absolute = metric_scale("mae");
  return {{"signed", absolute},
          {"absolute", absolute},
          {"relative", metric_scale("relative-rmse")},
          {"squared", metric_scale("mse")}};
}

/// What it takes to read the floats of a picture.
ordered_json floats_json(const Picture& picture) {
  if (!picture.floats) return nullptr;
  return {{"id", "f" + std::to_string(picture.floats->id)},
          {"width", picture.width_px},
          {"height", picture.height_px},
          {"channels", picture.floats->channels},
          {"exponent", picture.floats->exponent},
          {"non_finite", picture.floats->non_finite}};
}

/// The frames of a sequence by rising number, that of the page's picture among them; nothing of one
/// that has no others.
ordered_json frames_json(const Picture& picture, int frame,
                         const std::vector<FramePicture>& others) {
  ordered_json json = ordered_json::array();
  if (others.empty()) return json;
  std::vector<std::pair<int, const Picture*>> frames{{frame, &picture}};
  for (const FramePicture& one : others) {
    if (one.picture.floats) frames.emplace_back(one.frame, &one.picture);
  }
  std::sort(frames.begin(), frames.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [number, one] : frames) {
    json.push_back({{"frame", number}, {"floats", floats_json(*one)}});
  }
  return json;
}

ordered_json image_json(const std::string& label, const char* role, const Picture& picture,
                        const std::vector<FramePicture>& others, int frame) {
  ordered_json json{{"label", label},
                    {"role", role},
                    {"width", picture.width_px},
                    {"height", picture.height_px},
                    {"floats", floats_json(picture)}};
  if (!others.empty()) json["frames"] = frames_json(picture, frame, others);
  return json;
}

ordered_json images_json(const ReportData& data, const SceneView& scene) {
  ordered_json images = ordered_json::array();
  for (const ReferenceView& reference : scene.references) {
    if (reference.picture.is_empty()) continue;
    images.push_back(image_json(reference.label, "reference", reference.picture, reference.frames,
                                reference.frame));
  }
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    const SummaryRow& row = *scene.rows[i];
    if (scene.pictures[i].is_empty()) continue;
    images.push_back(image_json(row_label(data, row), "method", scene.pictures[i], scene.frames[i],
                                data.run.cells[*row.shown].render.frame));
  }
  return images;
}

ordered_json maps_json(const SceneView& scene) {
  ordered_json maps = ordered_json::array();
  for (std::size_t strip = 0; strip < scene.strips.size(); ++strip) {
    const metrics::MetricDescription* info = metric_info_of(scene.strips[strip].metric);
    for (const MapView& map : scene.strips[strip].maps) {
      const auto row = std::find(scene.rows.begin(), scene.rows.end(), map.row);
      const auto image = row_number(scene, static_cast<std::size_t>(row - scene.rows.begin()));
      if (map.picture.is_empty() || !image || info == nullptr) continue;
      maps.push_back({{"image", *image},
                      {"metric", scene.strips[strip].metric},
                      {"against", map.against},
                      {"group", scene.anchor + "-map-" + std::to_string(strip + 1)},
                      {"scale", scale_json(info->map_scale, info->map_unit)},
                      {"frame", map.frame},
                      {"floats", floats_json(map.picture)},
                      {"frames", frames_json(map.picture, map.frame, map.frames)}});
    }
  }
  return maps;
}

/// Pictures before `count` that are there.
template <class PictureAt>
std::size_t present_before(std::size_t count, const PictureAt& picture_at) {
  std::size_t present = 0;
  for (std::size_t i = 0; i < count; ++i) present += picture_at(i).is_empty() ? 0 : 1;
  return present;
}

/// JSON as a script element holds it. "<" occurs in strings only, where its escape means the same;
/// so do controls of direction, which are to be seen as spelled, as in the rest of the page.
std::string script_text(const std::string& json) {
  std::string text;
  for (std::string_view rest = json; !rest.empty();) {
    const base::FirstCharacter first = base::first_character(rest);
    if (rest.front() == '<') {
      text += "\\u003c";
    } else if (first.code_point && base::is_direction_control(*first.code_point)) {
      text += "\\" + base::spelled(*first.code_point);
    } else {
      text += rest.substr(0, first.bytes);
    }
    rest.remove_prefix(first.bytes);
  }
  return text;
}

}  // namespace

std::optional<std::size_t> reference_number(const SceneView& scene, std::size_t index) {
  if (scene.references[index].picture.is_empty()) return std::nullopt;
  return present_before(
      index, [&](std::size_t i) -> auto& { return scene.references[i].picture; });
}

std::optional<std::size_t> row_number(const SceneView& scene, std::size_t index) {
  if (scene.pictures[index].is_empty()) return std::nullopt;
  return present_before(
             scene.references.size(),
             [&](std::size_t i) -> auto& { return scene.references[i].picture; }) +
         present_before(
             index, [&](std::size_t i) -> auto& { return scene.pictures[i]; });
}

std::string viewer_manifest(const ReportData& data) {
  ordered_json scenes = ordered_json::array();
  for (const SceneView& scene : data.scenes) {
    scenes.push_back({{"anchor", scene.anchor},
                      {"name", scene.name},
                      {"exposure_ev", scene.exposure_ev},
                      {"images", images_json(data, scene)},
                      {"maps", maps_json(scene)}});
  }
  const ordered_json manifest{
      {"colors", color_list()}, {"differences", difference_scales()}, {"scenes", scenes}};
  return "<script type=\"application/json\" id=\"viewer-data\">" + script_text(to_line(manifest)) +
         "</script>\n";
}

}  // namespace results::html_report
