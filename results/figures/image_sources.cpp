#include "results/figures/image_sources.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/image_file.h"
#include "results/run_files.h"
#include "results/score_summary.h"

namespace results::figures {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using perception::Image;

namespace {

ImageSource missing_source(std::string reason) { return {{}, "", std::move(reason)}; }

const CellRecord* shown_cell(const FigureRun& run, std::size_t row) {
  const auto& shown = run.summary().rows[row].shown;
  return shown ? &run.run().cells[*shown] : nullptr;
}

/// The score record of a row's picture; null if there is none.
const MetricRecord* score_record(const FigureRun& run, std::size_t row, const std::string& metric,
                                 const std::string& against) {
  const CellRecord* cell = shown_cell(run, row);
  if (cell == nullptr) return nullptr;
  const MetricRecord* found = nullptr;
  for (const MetricRecord& record : run.run().metrics) {
    const bool is_of_frame = is_sequence_metric(record.metric) ? !record.map.empty()
                                                               : record.frame == cell->render.frame;
    const bool is_asked = record.cell == cell->cell && record.against == against &&
                          (metric.empty() || record.metric == metric);
    // Of a sequence metric with a map of every frame the first.
    if (is_asked && is_of_frame && (found == nullptr || record.frame < found->frame)) {
      found = &record;
    }
  }
  return found;
}

/// The hash of a scene's reference of all light, as run.json lists it; "" if it does not.
std::string listed_reference(const ordered_json& info, const std::string& scene) {
  const auto references = info.find("references");
  if (references == info.end() || !references->is_array()) return "";
  for (const ordered_json& entry : *references) {
    const bool is_clamped = entry.contains("geometry_clamp") && !entry["geometry_clamp"].is_null();
    const bool is_full =
        entry.value("scene", "") == scene && entry.value("transport", "") == "full";
    if (is_full && !is_clamped && entry.contains("hash")) return entry.value("hash", "");
  }
  return "";
}

}  // namespace

ImageSource rendering_of(const FigureRun& run, std::size_t row) {
  const CellRecord* cell = shown_cell(run, row);
  if (cell != nullptr) return {run.run().folder / cell->render.image, "", ""};
  return missing_source(run.summary().rows[row].repetitions == 0 ? "not yet" : "no image");
}

ImageSource reference_of(const FigureRun& run, const std::vector<std::size_t>& rows,
                         const std::string& against) {
  for (const std::size_t row : rows) {
    const MetricRecord* record = score_record(run, row, "", against);
    if (record == nullptr || record->reference_hash.empty()) continue;
    const bool is_indirect = against == "own" && shown_cell(run, row)->render.part == "indirect";
    return {reference_file(run.run().folder, record->reference_hash), is_indirect ? "indirect" : "",
            ""};
  }
  const std::string hash = rows.empty() || against == "own"
                               ? ""
                               : listed_reference(*run.run().info, run.rows()[rows.front()].scene);
  return hash.empty() ? missing_source("no reference")
                      : ImageSource{reference_file(run.run().folder, hash), "", ""};
}

ImageSource map_of(const FigureRun& run, std::size_t row, const Quantity& score) {
  const MetricRecord* record = score_record(run, row, score.name, score.against);
  if (record == nullptr) return missing_source("no score");
  if (record->map.empty()) return missing_source("no map was kept");
  return {run.run().folder / record->map, "", ""};
}

std::optional<Image> read_source(ImageSource& source) {
  if (!source.missing.empty()) return std::nullopt;
  std::error_code ignored;
  if (!fs::exists(source.file, ignored)) {
    source.missing = "no file";
    return std::nullopt;
  }
  try {
    perception::ImageFile file = perception::read_image_file(source.file);
    if (source.part.empty()) return std::move(file.parts.front().image);
    for (perception::NamedImage& part : file.parts) {
      if (part.name == source.part) return std::move(part.image);
    }
    source.missing = "no part " + source.part;
  } catch (const base::InputError& error) {
    source.missing = error.what();
  }
  return std::nullopt;
}

}  // namespace results::figures
