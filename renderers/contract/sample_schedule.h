#pragma once

#include <cstdint>
#include <optional>

#include "renderers/contract/renderer.h"

namespace renderers {

/// Progressive units [begin, end).
struct SampleRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

/// Decides how many units of a progressive renderer come next: up to powers of two, where
/// checkpoints are; under a time budget in small steps, until what is left of it is less than half
/// a unit's time.
class SampleSchedule {
 public:
  /// The job's samples, or its time alone; with neither, `default_samples`.
  SampleSchedule(const RenderJob& job, std::int64_t default_samples);

  /// @param done    units done so far
  /// @param used_s  seconds spent so far, checkpoints left out
  /// @return nothing when the picture is finished
  std::optional<SampleRange> next(std::int64_t done, double used_s) const;

  /// Whether the picture of so many units goes to the checkpoint sink.
  static bool is_checkpoint(std::int64_t done);

 private:
  std::int64_t samples_;
  std::optional<double> budget_s_;
};

}  // namespace renderers
