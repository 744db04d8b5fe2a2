#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/gates/gate_check.h"
#include "results/html_report/picture.h"
#include "results/result_store.h"
#include "results/run_summary.h"

namespace results::html_report {

/// One frame of a sequence besides the one that the page shows; floats only.
struct FramePicture {
  int frame = 0;
  Picture picture;
};

/// A reference image that scores of a scene are against.
struct ReferenceView {
  std::string hash;
  std::string part;   ///< part of reference.exr; "" is all light
  std::string label;  ///< "reference: full", "reference: diffuse, indirect"
  int frame = 0;      ///< that the picture is of
  Picture picture;
  std::vector<FramePicture> frames;  ///< the others, rising
};

/// The error map of one method.
struct MapView {
  const SummaryRow* row = nullptr;
  std::string against;  ///< "full", "own", or "own = full" where the references are the same
  const ScoreSummary* score = nullptr;  ///< never null
  int frame = 0;                        ///< that the picture is of
  Picture picture;
  std::vector<FramePicture> frames;  ///< of a sequence the others whose maps were kept, rising
};

/// One metric's maps of a scene: per method against all light, then against its own transport.
struct MapStrip {
  std::string metric;
  std::vector<MapView> maps;  ///< not empty
};

/// What the page shows of one scene.
struct SceneView {
  std::string name;
  std::string anchor;                   ///< id of its section, made of digits and letters of ours
  std::vector<const SummaryRow*> rows;  ///< methods and budgets, in the order of the suite
  std::vector<Picture> pictures;        ///< one per row: its first seed
  std::vector<std::vector<FramePicture>> frames;  ///< one per row: the others of a sequence, rising
  std::vector<ReferenceView> references;
  std::vector<MapStrip> strips;  ///< one per metric that kept maps
  double exposure_ev = 0.0;
};

/// Everything the sections of the page are written from.
struct ReportData {
  const Run& run;
  RunSummary summary;
  std::vector<SceneView> scenes;
  gates::GateReport gates;  ///< of the run, judged now; none of them is while the run goes on
  /// How the gates that concern a row came out, by scene, method and budget.
  std::map<std::array<std::string, 3>, std::vector<gates::Outcome>> outcomes;
};

/// Exposure of a scene's pictures, stops: its own if run.json has one, else that of the viewing
/// conditions, else 0.
double exposure_of(const nlohmann::ordered_json& info, const std::string& scene);

/// Reads the images of a run; their floats go to the store. @param run  must outlive the result
ReportData collect_report_data(const Run& run, FloatStore& store);

/// Name of a row within its scene: the method, and the budget if the method has several.
std::string row_label(const ReportData& data, const SummaryRow& row);

}  // namespace results::html_report
