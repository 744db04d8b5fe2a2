#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "perception/base/errors.h"
#include "results/result_store.h"
#include "results/row_selector.h"
#include "results/run_summary.h"

namespace results {

/// A named number of every row of a run, as claims, figures and tables ask for it.
///
/// | text | what |
/// |---|---|
/// | `total_s prepare_s render_s update_s next_frame_s new_view_s start_up_s readback_s` | times |
/// | `unattributed_s peak_memory_bytes pixels samples faces` | as in the record, and of the scene |
/// | `gather`, `gather/visibility` | a stage, all phases but new_view, less the readback in it; s |
/// | `vals`, `counter.vals` | a counter; every element of a series |
/// | `relmse`, `flip.p99`, `flip@full`, `flip.p99@full` | a score or a detail of it, own or full |
/// | `max_depth` | a swept value or a parameter |
///
/// A name that two kinds share is written with its kind: `stage.`, `counter.`, `score.`,
/// `parameter.`; without one, a parameter goes before the counter of its name. A metric is named by
/// its text in the suite or, if one only has that name, by its name. Of a sequence, times and
/// stages are those of its following frames; `first.total_s` and `first.gather` are those of its
/// first.
struct Quantity {
  enum class Kind { time, stage, counter, score, parameter };
  Kind kind = Kind::time;
  std::string name;             ///< "total_s", "gather/visibility", "vals", the metric's text
  std::string detail;           ///< of a score; "" is its value
  std::string against = "own";  ///< of a score: own | full
  bool is_first_frame = false;  ///< of a sequence, its first frame
  std::string text;             ///< as it was written
  std::string unit;             ///< "s", "bytes", the metric's; "" if it has none
};

/// One value of a quantity with what it is of. Repetitions tell the noise of time, seeds that of
/// the estimator: they are never mixed.
struct Sample {
  double value = 0.0;
  std::uint64_t seed = 1;
  int repetition = 0;  ///< 0 for scores
  int frame = 0;
};

/// A stored run, or one that is only planned, as rows with named numbers.
class RunValues {
 public:
  /// @param run  must outlive this object
  explicit RunValues(const Run& run);

  const Run& run() const { return run_; }
  const RunSummary& summary() const { return summary_; }
  /// One per row of the summary, in its order.
  const std::vector<RowFacts>& rows() const { return rows_; }

  /// @throws base::InputError with the place: no such quantity in this run (names those that
  ///   exist), or one of two kinds
  Quantity find_quantity(std::string_view text, const base::Place& place) const;
  /// Likewise of a run that is only planned: a name that may turn out to be a stage or a counter is
  /// accepted. @throws base::InputError with the place for one that cannot, e.g. a metric that this
  ///   run has no scores of
  void check_quantity(std::string_view text, const base::Place& place) const;
  /// Every text that `find_quantity` accepts without a prefix, details left out.
  std::vector<std::string> quantity_names() const;

  /// The finite values of a quantity of one row, of successful repetitions, by seed, repetition and
  /// frame; of a score one per seed and frame, of a parameter a single one.
  std::vector<Sample> samples(std::size_t row, const Quantity& quantity) const;

  /// What the tables show: of times, stages and counters the median over repetitions of the median
  /// over a repetition's frames; of scores the mean over seeds of the median over a seed's frames
  /// (of a sequence metric the mean over them); of a parameter its value. Nothing without samples.
  std::optional<Estimate> estimate(std::size_t row, const Quantity& quantity) const;

 private:
  void collect_names();
  std::vector<Quantity> candidates(std::string_view text, const base::Place& place) const;
  std::vector<std::string> metric_texts(std::string_view name) const;
  std::optional<Quantity> find_score(std::string_view name, const base::Place& place) const;

  const Run& run_;
  RunSummary summary_;
  std::vector<RowFacts> rows_;
  std::vector<std::vector<std::size_t>> scores_of_row_;  ///< indices into Run::metrics
  std::set<std::string> stage_names_;
  std::set<std::string> counter_names_;
  std::set<std::string> parameter_names_;  ///< those that are numbers
};

/// One value per group of samples that belong together: the median over the frames (the mean, if
/// `is_mean`) of each repetition and seed. @return in the order of seeds and repetitions
std::vector<double> values_over_frames(const std::vector<Sample>& samples, bool is_mean = false);

}  // namespace results
