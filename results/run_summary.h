#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "results/frame_times.h"
#include "results/result_store.h"
#include "results/score_summary.h"
#include "results/statistics.h"

namespace results {

/// All repetitions and seeds of one (scene, method, budget).
struct SummaryRow {
  std::string scene;
  std::string method;
  std::string budget;
  /// Median over successful repetitions of all seeds; of a sequence that of its first frame.
  std::optional<Estimate> total_s;
  std::optional<Estimate> new_view_s;  ///< likewise; absent if it was not measured
  FrameTimes next_frames;              ///< of a sequence; else empty
  std::size_t seeds = 0;               ///< cells with at least one record
  std::size_t missing_cells = 0;       ///< planned, no record yet
  /// Repetitions by status, as in `Status`; of a sequence its first status that is no success.
  std::vector<std::pair<Status, std::size_t>> statuses;
  std::vector<std::size_t> records;    ///< indices into Run::cells, in file order
  std::size_t repetitions = 0;         ///< with at least one record
  std::optional<std::size_t> typical;  ///< index of the repetition with the (lower) median total_s
  std::optional<std::size_t> shown;    ///< index of the first record with an image, first seed
  std::size_t frames = 0;              ///< different frames that have an image
  bool is_sequence = false;            ///< the suite asks for several frames
  std::vector<ScoreSummary> scores;    ///< every metric of the run, against own, then full

  bool has_failure() const;  ///< a status other than ok, cached, unsupported, skipped
  const ScoreSummary* find_score(const std::string& metric, const std::string& against) const;
};

/// A run as rows, in the order of the suite (run.json), else of first appearance.
struct RunSummary {
  std::vector<std::string> scenes;
  std::vector<std::string> methods;
  std::vector<std::string> budgets;
  std::vector<std::string> metrics;
  std::vector<SummaryRow> rows;  ///< sorted by scene, method, budget
  std::size_t ok_cells = 0;      ///< every repetition succeeded
  std::size_t failed_cells = 0;
  std::size_t skipped_cells = 0;  ///< unsupported or skipped
  std::size_t missing_cells = 0;  ///< planned, no record yet
};

/// Pure function of the stored results.
RunSummary summarize(const Run& run);

}  // namespace results
