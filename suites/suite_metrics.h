#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "metrics/metric_list.h"
#include "perception/base/document.h"

namespace suites {

struct SuiteMethod;
struct SuiteScene;

/// Which pixels take part in a score.
struct MaskSpec {
  enum class Kind {
    none,        ///< all
    above_half,  ///< where the image is above 0.5, in its greatest channel
    edges,       ///< up to `distance_px` away from a step of the AOV by more than 0.5
    interior     ///< farther away from one
  };
  Kind kind = Kind::none;
  std::string aov;             ///< of the reference; "" if it is a file
  std::filesystem::path file;  ///< absolute
  int distance_px = 0;
  /// "normal", "/path/mask.png", "edges of normal, 4 px", "interior of normal, 4 px"; "" for none.
  std::string text() const;
};

/// A metric of a suite, and what it scores.
struct SuiteMetric {
  SuiteMetric() = default;
  explicit SuiteMetric(metrics::AnyMetricChoice metric) : choice(std::move(metric)) {}

  metrics::AnyMetricChoice choice;  ///< its text names its scores: "relmse", "edges:relmse"
  std::string id;                   ///< "edges"; "" of a metric that is only named
  std::string image;                ///< an AOV that both pictures have; "": the radiance
  double scale = 1.0;               ///< of the AOV's values
  MaskSpec mask;
  std::vector<std::string> against{"own", "full"};
  std::vector<std::string> scenes;   ///< ids, with or without sweep values; empty: all
  std::vector<std::string> methods;  ///< likewise
  bool keeps_all_maps = false;       ///< of every frame, else of the first that has a score

  bool is_of_whole_picture() const { return image.empty() && mask.kind == MaskSpec::Kind::none; }
  bool needs_aovs() const { return !image.empty() || !mask.aov.empty(); }
  /// "irradiance", "irradiance * 0.3183"; "" of the radiance.
  std::string image_text() const;
};

/// What names the metric's scores.
inline const std::string& text_of(const SuiteMetric& metric) { return text_of(metric.choice); }

/// Reads `metrics`: texts, or maps of {id, metric, parameters, image, scale, mask, against, maps,
/// scenes, methods}.
/// @param folder  what mask files are relative to
/// @throws base::InputError with the place, also for an id or a text that is there twice
std::vector<SuiteMetric> read_metrics(const base::Node& node, const std::filesystem::path& folder);

/// @throws base::InputError for a scene or method that the suite lacks
void check_metric_places(const SuiteMetric& metric, const std::vector<SuiteScene>& scenes,
                         const std::vector<SuiteMethod>& methods, const base::Place& place);

/// Whether the metric scores this method on this scene.
bool is_wanted(const SuiteMetric& metric, const SuiteScene& scene, const SuiteMethod& method);

/// As in a suite; reading it back gives the same.
std::string to_yaml(const SuiteMetric& metric);
/// For run.json: the text, or {"id": text, "metric", ...} with what it is restricted to.
nlohmann::ordered_json to_json(const SuiteMetric& metric);

}  // namespace suites
