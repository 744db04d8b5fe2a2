#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "perception/base/document.h"
#include "perception/base/units.h"
#include "perception/viewing_conditions.h"
#include "results/claims/claim.h"
#include "results/claims/ledger.h"
#include "results/figures/figure_spec.h"
#include "results/gates/gate.h"
#include "suites/budgets.h"
#include "suites/frame_range.h"
#include "suites/measure_plan.h"
#include "suites/measurement.h"
#include "suites/suite_metrics.h"

namespace suites {

/// One picture that is the truth of what claims the same, e.g. the same virtual lights with a ray
/// to each: what a method adds to it is then all of the error.
struct OwnReference {
  MethodChoice choice;     ///< rendered once, with its own `samples`
  std::uint64_t seed = 1;  ///< that of the methods, so that the noise of equal parts cancels
};

/// How the truth of a scene is made.
struct ReferenceSpec {
  std::string renderer = "path";
  std::int64_t samples = 1024;
  std::uint64_t seed = 1000003;     ///< other than any method's seed
  std::optional<OwnReference> own;  ///< in place of `renderer` where it claims what is wanted
};

/// What one value of a sweep lays over the scene file.
struct SceneSetting {
  base::Node overlay;
  std::string path;  ///< of an axis of single values: where its value goes; else ""
};

struct SuiteScene {
  std::string id;       ///< unique; with sweep values: "horse[view=front,height=2]"
  std::string base_id;  ///< "horse"
  std::vector<std::pair<std::string, base::ParameterValue>> sweep;  ///< columns
  std::filesystem::path file;
  std::optional<base::Node> set;             ///< laid over the scene file first
  std::vector<SceneSetting> sweep_settings;  ///< one per entry of `sweep`
  std::vector<base::Node> overlays() const;  ///< all that is laid over the file, in order
  base::SizePx size_px{256, 256};
  FrameRange frames;
  ReferenceSpec reference;
  MeasureChange measure;  ///< of its cells
};

struct SuiteMethod {
  std::string id;       ///< unique; with sweep values: "val[vals=30,vpls=1024]"
  std::string base_id;  ///< "val"
  std::vector<std::pair<std::string, base::ParameterValue>> sweep;  ///< columns
  MethodChoice choice;
  std::vector<std::string> scenes;        ///< ids, with or without sweep values; empty: all
  std::vector<Budget> budgets;            ///< of its own; empty: the suite's
  std::optional<SearchedSetting> search;  ///< as the suite declares it
  MeasureChange measure;                  ///< of its cells; goes before its scene's
};

/// A suite file, read, checked and resolved for one profile.
struct Suite {
  std::string name;
  std::string summary;
  std::filesystem::path file;
  std::string profile;  ///< "" if the suite has none
  perception::ViewingConditions viewing;
  bool exposure_from_scene = true;
  std::vector<SuiteScene> scenes;
  std::vector<SuiteMethod> methods;
  std::vector<Budget> budgets;
  MeasurePlan measure;
  std::vector<SuiteMetric> metrics;
  /// What is made of the results; not part of what a run is known by.
  std::vector<results::claims::Claim> claims;
  std::optional<results::claims::Ledger> paper;  ///< the rows that the claims are of
  std::vector<results::figures::FigureSpec> figures;
  std::vector<results::gates::Gate> gates;
};

/// Reads a suite. @param profile  "" for none
/// @throws base::InputError with file:line:column and the accepted names
Suite read_suite(const std::filesystem::path& path, const std::string& profile);
Suite parse_suite(const base::Node& node, const std::filesystem::path& file,
                  const std::string& profile);

/// Frames that a scene must have so that a metric has a score: 1 of an image metric.
std::size_t frames_needed(const metrics::AnyMetricChoice& choice);
/// @throws base::InputError if the metric is one of sequences and no scene has enough frames
void require_frames(const metrics::AnyMetricChoice& choice, const std::vector<SuiteScene>& scenes,
                    const base::Place& place);

/// The suite in full, defaults included; reading it back gives the same suite.
std::string resolved_yaml(const Suite& suite);
/// The part of such a text that says what is measured: without claims, figures and gates.
std::string measured_part(const std::string& resolved);

/// The checkout that the program was built from.
std::filesystem::path source_folder();
/// suites/catalog of the checkout, or $DISCERN_SUITES.
std::filesystem::path catalog_folder();
/// suites/scenes of the checkout, or $DISCERN_SCENES.
std::filesystem::path scene_folder();
/// Names of the catalogue's suites, those of its folders as "papers/convergence", sorted.
std::vector<std::string> catalog_suite_names();
/// A suite by path or by catalogue name. @throws base::InputError with the nearest known name
std::filesystem::path find_suite(const std::string& path_or_name);

}  // namespace suites
