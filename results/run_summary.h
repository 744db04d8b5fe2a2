#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "metrics/metric.h"
#include "results/result_store.h"
#include "results/statistics.h"

namespace results {

/// One metric of one row: mean over seeds (frames of a seed are averaged first).
struct ScoreSummary {
  std::string metric;                 ///< the choice as written in the suite
  std::string against;                ///< own | full
  std::optional<Estimate> score;      ///< of the finite scores; absent: there is none (yet)
  std::size_t perfect = 0;            ///< seeds of infinite score: identical to the reference
  std::size_t non_finite = 0;         ///< seeds whose score is no number, finite or infinite
  std::optional<double> noise_floor;  ///< mean over seeds
  bool has_reference_noise = false;   ///< a good part of the error is noise of the reference

  /// The mean of the finite scores; infinity if there are infinite ones only.
  std::optional<double> value() const;
  std::size_t seeds() const;  ///< seeds that `value` is of
};

/// All repetitions and seeds of one (scene, method, budget).
struct SummaryRow {
  std::string scene;
  std::string method;
  std::string budget;
  std::optional<Estimate> total_s;  ///< median over successful repetitions of all seeds
  std::size_t seeds = 0;            ///< cells with at least one record
  std::size_t missing_cells = 0;    ///< planned, no record yet
  std::vector<std::pair<Status, std::size_t>> statuses;  ///< repetitions by status, as in `Status`
  std::vector<std::size_t> records;                      ///< indices into Run::cells, in file order
  std::optional<std::size_t> typical;  ///< index of the repetition with the (lower) median total_s
  std::optional<std::size_t> shown;    ///< index of the first successful record of the first seed
  std::vector<ScoreSummary> scores;    ///< every metric of the run, against own, then full

  std::size_t repetitions() const { return records.size(); }
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

/// The metric's entry by the text of a suite ("flip", "relmse,trim=0.001"), null if this build
/// does not know it.
const metrics::MetricInfo* metric_info_of(const std::string& metric);

}  // namespace results
