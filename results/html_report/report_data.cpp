#include "results/html_report/report_data.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/units.h"
#include "results/html_report/json_text.h"

namespace results::html_report {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

double exposure_in(const ordered_json& json, double fallback) {
  if (!json.is_object()) return fallback;
  const auto value = json.find("exposure_ev");
  return value != json.end() && value->is_number() ? value->get<double>() : fallback;
}

std::string own_part(const RenderRecord& render) {
  return render.part == "indirect" ? "indirect" : "";
}

std::string own_label(const RenderRecord& render) {
  std::string label = "reference: " + render.transport;
  if (render.part == "indirect") label += ", indirect";
  if (render.geometry_clamp) {
    label += fmt::format(", clamp {} /m²", base::format_significant(*render.geometry_clamp, 3));
  }
  return label;
}

/// Reads the pictures of one scene.
class SceneCollector {
 public:
  SceneCollector(const Run& run, const ScoresOfCell& scores, SceneView& view)
      : run_(run), scores_(scores), view_(view) {}

  void collect(const std::vector<std::string>& metrics) {
    for (const SummaryRow* row : view_.rows) view_.pictures.push_back(picture_of(*row));
    // All light first: it is what every method is compared with on the page.
    collect_reference_of_run();
    collect_references("full");
    collect_references("own");
    for (const std::string& metric : metrics) collect_strip(metric);
  }

 private:
  Picture picture_of(const SummaryRow& row) const {
    if (!row.shown) {
      Picture none;
      none.missing = row.repetitions == 0 ? "not yet" : "no image";
      return none;
    }
    const RenderRecord& render = run_.cells[*row.shown].render;
    return rendering_picture(run_.folder / render.image, "", view_.exposure_ev);
  }

  /// The reference of all light, as soon as it is made; the scores come later.
  void collect_reference_of_run() {
    const auto references = run_.info->find("references");
    if (references == run_.info->end() || !references->is_array()) return;
    for (const ordered_json& entry : *references) {
      const bool is_full = text_at(entry, {"scene"}) == view_.name && is_of_first_frame(entry) &&
                           text_at(entry, {"transport"}) == "full" &&
                           text_at(entry, {"geometry_clamp"}).empty();
      const std::string hash = text_at(entry, {"hash"});
      if (is_full && !hash.empty()) add_reference(hash, "", "reference: full");
    }
  }

  /// The page shows the first frame of a sequence.
  bool is_of_first_frame(const ordered_json& reference) const {
    const auto scenes = run_.info->find("scenes");
    if (!reference.contains("frame") || scenes == run_.info->end()) return true;
    return std::none_of(scenes->begin(), scenes->end(), [&](const ordered_json& scene) {
      return text_at(scene, {"id"}) == view_.name && scene.contains("frame") &&
             scene.at("frame") != reference.at("frame");
    });
  }

  void collect_references(const std::string& against) {
    for (const SummaryRow* row : view_.rows) {
      for (const std::size_t index : row->records) {
        const CellRecord& cell = run_.cells[index];
        for (const MetricRecord* score : scores_of(cell.cell)) {
          if (score->against != against || score->frame != shown_frame(*row)) continue;
          const bool is_own = against == "own";
          add_reference(score->reference_hash, is_own ? own_part(cell.render) : "",
                        is_own ? own_label(cell.render) : "reference: full");
        }
      }
    }
  }

  /// Number of the frame that a row's picture shows; nothing if it has none.
  std::optional<int> shown_frame(const SummaryRow& row) const {
    if (!row.shown) return std::nullopt;
    return run_.cells[*row.shown].render.frame;
  }

  void add_reference(const std::string& hash, const std::string& part, const std::string& label) {
    for (const ReferenceView& known : view_.references) {
      if (known.hash == hash && known.part == part) return;
    }
    // <results>/runs/<suite>/<run> and <results>/references/<hash>
    const fs::path file = run_.folder / "../../../references" / hash / "reference.exr";
    view_.references.push_back(
        {hash, part, label, rendering_picture(file, part, view_.exposure_ev)});
  }

  void collect_strip(const std::string& metric) {
    MapStrip strip;
    strip.metric = metric;
    for (const SummaryRow* row : view_.rows) {
      if (!row->shown) continue;
      const CellRecord& cell = run_.cells[*row->shown];
      const MetricRecord* full = find_score(cell, metric, "full");
      const MetricRecord* own = find_score(cell, metric, "own");
      const bool is_same = full != nullptr && own != nullptr && own_part(cell.render).empty() &&
                           own->reference_hash == full->reference_hash;
      add_map(*row, full, is_same ? "own = full" : "full", strip);
      if (!is_same) add_map(*row, own, "own", strip);
    }
    if (!strip.maps.empty()) view_.strips.push_back(std::move(strip));
  }

  void add_map(const SummaryRow& row, const MetricRecord* score, const std::string& against,
               MapStrip& strip) const {
    if (score == nullptr || score->map.empty()) return;
    const metrics::MetricDescription* info = metric_info_of(strip.metric);
    if (info == nullptr) return;  // this build does not know the metric, nor its scale
    MapView view;
    view.row = &row;
    view.against = against;
    view.score = row.find_score(strip.metric, score->against);
    view.picture = map_picture(run_.folder / score->map, info->map_scale);
    strip.maps.push_back(std::move(view));
  }

  /// The score of the frame that the record is of; of a sequence metric, which has none of a first
  /// frame, the one whose map was kept.
  const MetricRecord* find_score(const CellRecord& cell, const std::string& metric,
                                 const std::string& against) const {
    for (const MetricRecord* score : scores_of(cell.cell)) {
      const bool is_of_frame =
          is_sequence_metric(metric) ? !score->map.empty() : score->frame == cell.render.frame;
      if (is_of_frame && score->metric == metric && score->against == against) return score;
    }
    return nullptr;
  }

  const std::vector<const MetricRecord*>& scores_of(const std::string& cell) const {
    static const std::vector<const MetricRecord*> kNone;
    const auto found = scores_.find(cell);
    return found == scores_.end() ? kNone : found->second;
  }

  const Run& run_;
  const ScoresOfCell& scores_;
  SceneView& view_;
};

}  // namespace

double exposure_of(const ordered_json& info, const std::string& scene) {
  const auto viewing = info.find("viewing");
  const double exposure_ev = viewing == info.end() ? 0.0 : exposure_in(*viewing, 0.0);
  const auto scenes = info.find("scenes");
  if (scenes == info.end() || !scenes->is_array()) return exposure_ev;
  for (const ordered_json& entry : *scenes) {
    if (entry.is_object() && entry.value("id", "") == scene) {
      return exposure_in(entry, exposure_ev);
    }
  }
  return exposure_ev;
}

ReportData collect_report_data(const Run& run) {
  ReportData data{run, summarize(run), {}};
  ScoresOfCell scores;
  for (const MetricRecord& record : run.metrics) scores[record.cell].push_back(&record);
  for (std::size_t i = 0; i < data.summary.scenes.size(); ++i) {
    SceneView view;
    view.name = data.summary.scenes[i];
    view.anchor = fmt::format("scene-{}", i + 1);
    view.exposure_ev = exposure_of(*run.info, view.name);
    for (const SummaryRow& row : data.summary.rows) {
      if (row.scene == view.name) view.rows.push_back(&row);
    }
    SceneCollector(run, scores, view).collect(data.summary.metrics);
    data.scenes.push_back(std::move(view));
  }
  return data;
}

std::string row_label(const ReportData& data, const SummaryRow& row) {
  const auto is_other_budget = [&](const SummaryRow& other) {
    return other.method == row.method && other.budget != row.budget;
  };
  const auto& rows = data.summary.rows;
  if (std::none_of(rows.begin(), rows.end(), is_other_budget)) return row.method;
  return row.method + " · " + row.budget;
}

}  // namespace results::html_report
