#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "perception/base/document.h"

namespace suites {

/// How cells are measured.
struct MeasurePlan {
  int seeds = 1;
  int min_repetitions = 1;
  int max_repetitions = 1;
  double until_relative_spread = 0.02;  ///< stop repeating when the median's interval is this tight
  int warmup = 1;
  bool is_interleaved = true;
  bool has_new_view = false;     ///< measure new_view_s, too
  bool has_convergence = false;  ///< keep and score the checkpoints of every seed
  double timeout_s = 600.0;
  std::int64_t memory_bytes = std::int64_t{8} << 30;
};

/// How often a cell is repeated.
struct RepetitionRange {
  int min = 1;
  int max = 1;
  std::optional<double> until_relative_spread;  ///< absent: as it was
};

/// What a scene or a method measures otherwise than its suite; what is absent stays as it is.
struct MeasureChange {
  std::optional<int> seeds;
  std::optional<RepetitionRange> repetitions;
  std::optional<double> timeout_s;
  std::optional<std::int64_t> memory_bytes;
  bool is_empty() const { return !seeds && !repetitions && !timeout_s && !memory_bytes; }
};

/// `measure` of a suite. @throws base::InputError with the place
MeasurePlan read_measure(const base::Node& node);
/// `measure` of a scene or a method: seeds, repetitions, timeout, memory.
/// @throws base::InputError with the place
MeasureChange read_measure_change(const base::Node& node);

MeasurePlan with_change(MeasurePlan plan, const MeasureChange& change);

/// "{seeds: 2, repetitions: {min: 3, max: 9}}": reading it back gives the same change.
std::string to_yaml(const MeasureChange& change);

}  // namespace suites
