#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "results/run_record.h"
#include "suites/run_plan.h"

namespace suites {

/// What a stored reference cost.
struct MeasuredReference {
  std::string scene_hash;
  std::string renderer;
  std::string transport;
  double pixel_samples = 0.0;  ///< pixels times samples per pixel
  double seconds = 0.0;
};

/// What was measured on this machine.
struct CostRecords {
  std::vector<results::RenderRecord> repetitions;  ///< of a sequence one per frame
  std::vector<MeasuredReference> references;
};

/// Wall time between the least and the greatest number of repetitions, seconds.
struct CostRange {
  double least_s = 0.0;
  double most_s = 0.0;
};

/// What a plan is expected to cost. Scores are left out: nothing measures them.
struct CostEstimate {
  std::size_t cells = 0;
  std::size_t least_repetitions = 0;  ///< unsupported cells have none
  std::size_t most_repetitions = 0;
  std::size_t references = 0;  ///< to be rendered, or extended
  CostRange total;             ///< of all that is not counted as unmeasured; references included
  double references_s = 0.0;
  /// Cells by what they are estimated from.
  std::size_t from_same_scene = 0;
  std::size_t from_same_renderer = 0;
  std::size_t from_time_budget = 0;
  std::size_t unmeasured_cells = 0;
  std::size_t unmeasured_references = 0;
};

/// Pure function of a plan and of what was measured.
///
/// A repetition is estimated from the successes of its renderer: those of its scene with its
/// parameters, else of its scene, else with its parameters, else all; of those the ones nearest in
/// pixels times samples, because small images are mostly overhead. It costs the median of their
/// prepare_s + render_s, render_s scaled by pixels and by samples, a following frame with its
/// update; start_up_s is added once per scene and method. A budget of time costs itself per frame.
/// A search costs three repetitions of its cell. A reference costs the median seconds per pixel and
/// sample of those nearest to it likewise.
///
/// @param stored_samples  of each reference of the plan
CostEstimate estimate_cost(const RunPlan& plan, const CostRecords& records,
                           const std::vector<std::int64_t>& stored_samples);

/// "1 h 05 min", "3 min 20 s", "12 s", "under 1 s".
std::string cost_text(double seconds);

}  // namespace suites
