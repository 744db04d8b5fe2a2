#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "metrics/metric_list.h"
#include "perception/base/units.h"
#include "results/html_report/color_bar.h"
#include "results/html_report/html_text.h"
#include "results/html_report/sections.h"
#include "results/html_report/viewer_manifest.h"
#include "results/tables.h"

namespace results::html_report {

namespace {

struct Caption {
  std::string name;    ///< bold
  std::string detail;  ///< beside it
  std::string label;   ///< name in the viewer
};

/// How the viewer finds a picture.
struct ViewerPlace {
  std::string group;                 ///< of pictures that flip in place
  std::optional<std::size_t> image;  ///< number in its scene
  std::string against;               ///< of error maps
};

/// A picture with its caption; pictures of one group flip in place in the viewer.
std::string figure(const Picture& picture, const ViewerPlace& place, const Caption& caption) {
  const std::string text = fmt::format("<figcaption><b>{}</b><span>{}</span></figcaption>",
                                       escape(caption.name), escape(caption.detail));
  if (picture.is_empty()) {
    return fmt::format("<figure><div class=\"no-picture\">{}</div>{}</figure>\n",
                       escape(picture.missing), text);
  }
  std::string attributes = fmt::format("data-group=\"{}\"", place.group);
  if (place.image) attributes += fmt::format(" data-image=\"{}\"", *place.image);
  if (!place.against.empty()) attributes += fmt::format(" data-against=\"{}\"", place.against);
  return fmt::format(
      "<figure><img class=\"picture\" src=\"{}\" width=\"{}\" height=\"{}\" {} "
      "alt=\"{}\">{}</figure>\n",
      picture.uri, picture.width_px, picture.height_px, attributes, escape(caption.label), text);
}

std::string non_finite_text(const Picture& picture) {
  if (!picture.floats || picture.floats->non_finite == 0) return "";
  return fmt::format("{} non-finite pixels", picture.floats->non_finite);
}

std::string image_detail(const ReportData& data, const SummaryRow& row) {
  if (!row.shown) return format_statuses(row);
  const RenderRecord& render = data.run.cells[*row.shown].render;
  std::string detail = base::format_duration(render.total_s);
  if (render.samples) detail += fmt::format(" · {} samples", *render.samples);
  if (row.seeds > 1) detail += fmt::format(" · seed {}", render.seed);
  if (render.non_finite_pixels > 0) {
    detail += fmt::format(" · {} non-finite pixels", render.non_finite_pixels);
  }
  return detail;
}

bool is_sequence(const SceneView& scene) {
  return std::any_of(scene.rows.begin(), scene.rows.end(),
                     [](const SummaryRow* row) { return !row->next_frames.frames.empty(); });
}

std::string images(const ReportData& data, const SceneView& scene) {
  std::string html = "<h3>Images</h3>\n";
  html += fmt::format(
      "<p class=\"note\">sRGB, exposure {} EV. Click an image for its float values: "
      "exposure, differences, error maps, values of pixels; keys flip between methods in place.{}"
      "</p>\n",
      base::format_significant(scene.exposure_ev, 3),
      is_sequence(scene) ? " Of the sequence its first frame is shown." : "");
  html += "<div class=\"pictures\">\n";
  for (std::size_t i = 0; i < scene.references.size(); ++i) {
    const ReferenceView& reference = scene.references[i];
    html += figure(reference.picture, {scene.anchor, reference_number(scene, i), ""},
                   {reference.label, non_finite_text(reference.picture), reference.label});
  }
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    const std::string label = row_label(data, *scene.rows[i]);
    const std::string detail = image_detail(data, *scene.rows[i]);
    html +=
        figure(scene.pictures[i], {scene.anchor, row_number(scene, i), ""}, {label, detail, label});
  }
  return html + "</div>\n";
}

std::string color_bar_of(const metrics::MetricDescription& info) {
  perception::MapScale scale = info.map_scale;
  if (scale.unit.empty()) scale.unit = info.map_unit;
  return color_bar(scale);
}

std::string map_strip(const ReportData& data, const SceneView& scene, std::size_t index) {
  const MapStrip& strip = scene.strips[index];
  const metrics::MetricDescription* info = metric_info_of(strip.metric);
  std::string html = fmt::format("<div class=\"strip\"><h4>{}</h4>{}\n<div class=\"pictures\">\n",
                                 escape(strip.metric), info == nullptr ? "" : color_bar_of(*info));
  const std::string group = fmt::format("{}-map-{}", scene.anchor, index + 1);
  for (const MapView& map : strip.maps) {
    const std::string score = format_score(*map.row, *map.score);
    const std::string label = row_label(data, *map.row);
    const auto row = std::find(scene.rows.begin(), scene.rows.end(), map.row);
    const auto image = row_number(scene, static_cast<std::size_t>(row - scene.rows.begin()));
    html += figure(map.picture, {group, image, map.against},
                   {label, map.against + ": " + score, label + " · " + map.against});
  }
  return html + "</div></div>\n";
}

std::string error_maps(const ReportData& data, const SceneView& scene) {
  if (scene.strips.empty()) return "";
  std::string html =
      "<h3>Error maps</h3>\n<p class=\"note\">One fixed scale per metric, the same in every "
      "report. full: against all light; own: against the transport the method claims. Cyan: not "
      "a finite number.";
  html += is_sequence(scene)
              ? " The maps are of the first frame that has a score, the numbers of all.</p>\n"
              : "</p>\n";
  for (std::size_t i = 0; i < scene.strips.size(); ++i) html += map_strip(data, scene, i);
  return html;
}

std::string score_cell(const SummaryRow& row, const ScoreSummary& score) {
  std::string notes;
  const std::string note = format_score_note(row, score);
  if (!note.empty()) notes = fmt::format("<small>{}</small>", note);
  if (score.noise_floor) {
    notes +=
        fmt::format("<small>floor {}</small>", base::format_significant(*score.noise_floor, 2));
  }
  const std::string text = format_score(row, score);
  const std::optional<double> value = score.value();
  if (!value) return fmt::format("<td class=\"n none\">{}{}</td>", text, notes);
  return fmt::format("<td class=\"n{}\"{}>{}{}{}</td>",
                     score.has_reference_noise ? " reference-noise" : "", sort_attribute(*value),
                     score.has_reference_noise ? "~" : "", text, notes);
}

std::string score_head(const ReportData& data) {
  std::string head = "<th>method</th>";
  for (const std::string& metric : data.summary.metrics) {
    const metrics::MetricDescription* info = metric_info_of(metric);
    std::string about = info == nullptr ? "unknown to this build" : info->unit;
    if (info != nullptr) {
      if (!about.empty()) about += ", ";
      about += info->better == metrics::Better::lower ? "lower is better" : "higher is better";
    }
    for (const char* against : {"own", "full"}) {
      head +=
          fmt::format("<th>{} ({})<small>{}</small></th>", escape(metric), against, escape(about));
    }
  }
  return head;
}

std::string score_table(const ReportData& data, const SceneView& scene) {
  if (data.summary.metrics.empty()) return "";
  std::string body;
  for (const SummaryRow* row : scene.rows) {
    body += fmt::format("<tr><th scope=\"row\">{}</th>", escape(row_label(data, *row)));
    for (const ScoreSummary& score : row->scores) body += score_cell(*row, score);
    body += "</tr>\n";
  }
  return "<h3>Scores</h3>\n<div class=\"scroll\"><table class=\"sortable numbers\"><thead><tr>" +
         score_head(data) + "</tr></thead><tbody>\n" + body +
         "</tbody></table></div>\n<p class=\"note\">Mean over seeds ± 95 % interval; " +
         escape(sequence_score_note(data.summary.metrics)) +
         ". Beside it the worst frame and its number. floor: the "
         "score that the noise of the reference alone would give; ~ more than a tenth of the error "
         "is noise of the reference. ∞: identical to the reference.</p>\n";
}

}  // namespace

std::string scene_section(const ReportData& data, const SceneView& scene) {
  return fmt::format("<section id=\"{}\" class=\"scene\"><h2>{}</h2>\n", scene.anchor,
                     escape(scene.name)) +
         images(data, scene) + score_table(data, scene) + convergence_part(data, scene) +
         sequence_part(data, scene) + error_maps(data, scene) + stage_part(data, scene) +
         "</section>\n";
}

}  // namespace results::html_report
