#pragma once

#include <optional>
#include <span>
#include <vector>

#include "results/run_record.h"
#include "results/statistics.h"

namespace results {

/// Time of one following frame of a sequence.
struct FrameTime {
  int frame = 0;
  Estimate next_frame_s;  ///< median over repetitions of all seeds
};

/// The times of a sequence's following frames: next_frame_s.
struct FrameTimes {
  /// Median over repetitions of all seeds of what half (p50), and 95 % (p95), of a repetition's
  /// frames stay below.
  std::optional<Estimate> p50_s;
  std::optional<Estimate> p95_s;
  std::vector<FrameTime> frames;  ///< by frame
  /// Index, into the records, of the frame whose time is the (lower) median of all.
  std::optional<std::size_t> typical;
};

/// @param records  those of one (scene, method, budget); what is no successful following frame is
///   left out
FrameTimes frame_times(const std::vector<CellRecord>& cells, std::span<const std::size_t> records);

}  // namespace results
