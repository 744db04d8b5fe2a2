#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/run_values.h"

namespace results::figures {

/// A run as `RunValues` gives it, with every estimate made once: the interval of a median costs
/// thousands of resamples, and the figures of a suite ask for the same ones. For several threads.
class FigureRun {
 public:
  /// @param values  must outlive this object; not explicit, since it is the same run
  FigureRun(const RunValues& values) : values_(values) {}

  const RunValues& values() const { return values_; }
  const Run& run() const { return values_.run(); }
  const RunSummary& summary() const { return values_.summary(); }
  const std::vector<RowFacts>& rows() const { return values_.rows(); }
  Quantity find_quantity(std::string_view text, const base::Place& place) const {
    return values_.find_quantity(text, place);
  }
  std::vector<Sample> samples(std::size_t row, const Quantity& quantity) const {
    return values_.samples(row, quantity);
  }
  std::optional<Estimate> estimate(std::size_t row, const Quantity& quantity) const;

 private:
  const RunValues& values_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::optional<Estimate>> estimates_;
};

}  // namespace results::figures
