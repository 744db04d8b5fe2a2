#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/claims/resampling.h"
#include "results/run_values.h"

namespace results::claims {

/// Numbers of a run's rows with what they become when their samples are drawn again.
///
/// A row that lacks any of its cells, or has a failure, has no number: what is left of it may be
/// the better part. All functions throw base::InputError with the reason, which names what the row
/// does have; `evaluate` makes that a claim's reason.
class RowNumbers {
 public:
  /// @param values  must outlive this object
  explicit RowNumbers(const RunValues& values) : values_(values) {}

  const RunValues& values() const { return values_; }

  /// As RunValues::estimate.
  const Number& estimate(std::size_t row, const Quantity& quantity);
  /// Part of the time that stages take together, repetition by repetition.
  /// @param lacks_none  a stage that the row lacks is an error; else it takes no time
  Number share(std::size_t row, std::span<const Quantity> stages, bool lacks_none = true);
  /// The last value of a repetition or a seed: of its last frame, the last of a series.
  Number last(std::size_t row, const Quantity& quantity);
  /// Of all samples of the rows: frames, elements of series, repetitions.
  Number quantile(std::span<const std::size_t> rows, const Quantity& quantity, double q);
  Number share_of(std::span<const std::size_t> rows, const Quantity& quantity,
                  const std::function<bool(double)>& condition);

  /// The stages that a row's records have, but those of a new view.
  std::set<std::string> stage_paths(std::size_t row) const;
  /// "val[vals=30] on horse at 64spp".
  std::string row_name(std::size_t row) const;

 private:
  std::vector<Sample> samples(std::size_t row, const Quantity& quantity) const;
  void require_complete(std::size_t row) const;
  std::vector<PooledSample> pool(std::span<const std::size_t> rows, const Quantity& quantity,
                                 std::vector<PooledRow>& pooled) const;

  const RunValues& values_;
  std::map<std::pair<std::size_t, std::string>, Number> estimates_;
};

}  // namespace results::claims
