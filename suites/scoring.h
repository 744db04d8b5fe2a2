#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/result_store.h"
#include "suites/cell_progress.h"
#include "suites/progress_meter.h"
#include "suites/reference_images.h"
#include "suites/run_plan.h"

namespace suites {

/// The viewing conditions of one scene: the suite's, with the scene's luminance scale unless the
/// suite states one, and exposure 0 EV where it is left to the scene.
perception::ViewingConditions viewing_of(const Suite& suite, const renderers::scene::Scene& scene);

/// The cells of a plan with what is known of each.
struct ScoringInput {
  const Suite& suite;
  const RunPlan& plan;
  const std::vector<std::size_t>& cells;      ///< indices into plan.cells: those to score
  const std::vector<CellProgress>& progress;  ///< one per cell of the plan
  ReferenceStore& references;
  /// Scores that are there already and need not be made again.
  const std::vector<results::MetricRecord>& known;
};

struct ScoringOutcome {
  std::size_t scores = 0;             ///< made now
  std::vector<std::string> failures;  ///< "<cell> <metric> <against>: reason"
};

/// Scores the stored image of every frame of the cells against its own reference and against
/// `full`.
///
/// Maps are kept for seed 1, of a sequence for the first frame that has a score. A score is skipped
/// if `known` holds it with the same image, reference, metric version and viewing conditions, those
/// of the other frames included that it depends on. Sequence metrics score the frames that have an
/// image and enough frames with one right before them. A metric that follows the reference has one
/// setting for all frames of a sequence.
/// @throws Interrupted
ScoringOutcome score_cells(const ScoringInput& input, results::RunFolder& folder,
                           ProgressMeter& meter);

/// Scores of a cell whose images are all there.
std::size_t score_count(const Suite& suite, const PlannedCell& cell);

/// Scores that `score_cells` would make, for each of `input.cells`.
std::vector<std::size_t> missing_scores(const ScoringInput& input);

}  // namespace suites
