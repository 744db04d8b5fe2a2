#include "results/html_report/report_data.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/units.h"
#include "results/gates/run_gates.h"
#include "results/html_report/json_text.h"
#include "results/run_files.h"

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
    for (const SummaryRow* row : view_.rows) {
      view_.pictures.push_back(picture_of(*row));
      view_.frames.push_back(other_frames(*row));
    }
    // All light first: it is what every method is compared with on the page.
    collect_reference_of_run();
    collect_references("full");
    collect_references("own");
    for (const std::string& metric : metrics) collect_strip(metric);
    for (ReferenceView& reference : view_.references) collect_frames(reference);
  }

 private:
  Picture picture_of(const SummaryRow& row) const {
    Picture picture;
    if (!row.shown) {
      picture.missing = row.repetitions == 0 ? "not yet" : "no image";
      return picture;
    }
    picture.source = rendering(run_.folder / run_.cells[*row.shown].render.image, "");
    return picture;
  }

  PictureSource rendering(const fs::path& path, const std::string& part) const {
    return {path, part, view_.exposure_ev, std::nullopt, true};
  }

  FramePicture frame_picture(int frame, const fs::path& path, const std::string& part) const {
    FramePicture one;
    one.frame = frame;
    one.picture.source = rendering(path, part);
    one.picture.source.has_preview = false;
    return one;
  }

  /// The frames of the cell and repetition that is shown, without the one that is.
  std::vector<FramePicture> other_frames(const SummaryRow& row) const {
    std::map<int, FramePicture> frames;
    if (row.shown) {
      const CellRecord& shown = run_.cells[*row.shown];
      for (const std::size_t index : row.records) {
        const CellRecord& cell = run_.cells[index];
        const int frame = cell.render.frame;
        const bool is_other = cell.cell == shown.cell && cell.repetition == shown.repetition &&
                              frame != shown.render.frame && !cell.render.image.empty();
        if (is_other) frames[frame] = frame_picture(frame, run_.folder / cell.render.image, "");
      }
    }
    return in_order(std::move(frames));
  }

  static std::vector<FramePicture> in_order(std::map<int, FramePicture> frames) {
    std::vector<FramePicture> result;
    for (auto& [frame, picture] : frames) result.push_back(std::move(picture));
    return result;
  }

  /// The reference's other frames, as far as scores name them.
  void collect_frames(ReferenceView& reference) const {
    std::map<int, FramePicture> frames;
    for (const SummaryRow* row : view_.rows) {
      if (!row->is_sequence) continue;
      for (const std::size_t index : row->records) {
        const CellRecord& cell = run_.cells[index];
        for (const MetricRecord* score : scores_of(cell.cell)) {
          const bool is_own = score->against == "own";
          const std::string part = is_own ? own_part(cell.render) : "";
          const std::string label = is_own ? own_label(cell.render) : "reference: full";
          if (score->frame == reference.frame || label != reference.label) continue;
          frames[score->frame] =
              frame_picture(score->frame, reference_file(run_.folder, score->reference_hash), part);
        }
      }
    }
    reference.frames = in_order(std::move(frames));
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
      const auto frame = entry.find("frame");
      const bool has_frame = frame != entry.end() && frame->is_number_integer();
      const int number = has_frame ? frame->get<int>() : 0;
      if (is_full && !hash.empty()) add_reference(hash, "", "reference: full", number);
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
                        is_own ? own_label(cell.render) : "reference: full", score->frame);
        }
      }
    }
  }

  /// Number of the frame that a row's picture shows; nothing if it has none.
  std::optional<int> shown_frame(const SummaryRow& row) const {
    if (!row.shown) return std::nullopt;
    return run_.cells[*row.shown].render.frame;
  }

  void add_reference(const std::string& hash, const std::string& part, const std::string& label,
                     int frame) {
    for (const ReferenceView& known : view_.references) {
      if (known.hash == hash && known.part == part) return;
    }
    ReferenceView view{hash, part, label, frame, {}, {}};
    view.picture.source = rendering(reference_file(run_.folder, hash), part);
    view_.references.push_back(std::move(view));
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
    view.frame = score->frame;
    view.picture.source = {run_.folder / score->map, "", 0.0, info->map_scale, true};
    for (const MetricRecord* other : maps_of_other_frames(*score)) {
      FramePicture one = frame_picture(other->frame, run_.folder / other->map, "");
      one.picture.source.scale = info->map_scale;
      view.frames.push_back(std::move(one));
    }
    strip.maps.push_back(std::move(view));
  }

  /// Scores alike whose maps were kept, by rising frame.
  std::vector<const MetricRecord*> maps_of_other_frames(const MetricRecord& score) const {
    std::map<int, const MetricRecord*> others;
    for (const MetricRecord* other : scores_of(score.cell)) {
      const bool is_alike = other->metric == score.metric && other->against == score.against;
      if (is_alike && other->frame != score.frame && !other->map.empty()) {
        others[other->frame] = other;
      }
    }
    std::vector<const MetricRecord*> result;
    for (const auto& [frame, other] : others) result.push_back(other);
    return result;
  }

  /// The score of the frame that the record is of; of a sequence metric, which has none of a first
  /// frame, the first whose map was kept.
  const MetricRecord* find_score(const CellRecord& cell, const std::string& metric,
                                 const std::string& against) const {
    const MetricRecord* found = nullptr;
    for (const MetricRecord* score : scores_of(cell.cell)) {
      const bool is_of_frame =
          is_sequence_metric(metric) ? !score->map.empty() : score->frame == cell.render.frame;
      const bool is_asked = score->metric == metric && score->against == against;
      if (is_of_frame && is_asked && (found == nullptr || score->frame < found->frame)) {
        found = score;
      }
    }
    return found;
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

/// A baseline that cannot be read is a note, not the end of the report.
gates::GateReport gates_of(const Run& run) {
  const std::string state = text_at(*run.info, {"state"});
  if (!state.empty() && state != "complete") {
    return gates::unjudged_gates(run, "the run is not complete: its gates are not judged");
  }
  try {
    return gates::judged_gates(results_root_of(run.folder), run);
  } catch (const base::InputError& error) {
    return gates::unjudged_gates(run, error.what());
  }
}

/// Every picture of the page, in an order that depends on the run alone.
std::vector<Picture*> pictures_of(ReportData& data) {
  std::vector<Picture*> pictures;
  const auto add_frames = [&](std::vector<FramePicture>& frames) {
    for (FramePicture& frame : frames) pictures.push_back(&frame.picture);
  };
  for (SceneView& scene : data.scenes) {
    for (ReferenceView& reference : scene.references) pictures.push_back(&reference.picture);
    for (Picture& picture : scene.pictures) pictures.push_back(&picture);
    for (MapStrip& strip : scene.strips) {
      for (MapView& map : strip.maps) pictures.push_back(&map.picture);
    }
    for (ReferenceView& reference : scene.references) add_frames(reference.frames);
    for (std::vector<FramePicture>& frames : scene.frames) add_frames(frames);
    for (MapStrip& strip : scene.strips) {
      for (MapView& map : strip.maps) add_frames(map.frames);
    }
  }
  return pictures;
}

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

ReportData collect_report_data(const Run& run, FloatStore& store) {
  ReportData data{run, summarize(run), {}, gates_of(run), {}};
  for (const gates::GateEntry& entry : data.gates.entries) {
    const comparison::Change& change = entry.change;
    data.outcomes[{change.scene, change.method, change.budget}].push_back(
        gates::outcome_of(change));
  }
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
  fill_pictures(pictures_of(data), store);
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
