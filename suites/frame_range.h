#pragma once

#include <string>
#include <vector>

#include "perception/base/document.h"

namespace suites {

/// The frames of a scene that a suite renders: one, or a sequence.
struct FrameRange {
  int first = 0;
  int last = 0;  ///< at most; first, first + step, ...
  int step = 1;
  bool is_sequence = false;  ///< `frames` rather than `frame`
  base::Place place;         ///< in the suite file

  std::vector<int> numbers() const;
};

/// Reads `frame: N`, `frames: [first, last]` or `frames: {first, last, step: 1}` of a scene entry;
/// frame 0 if it has neither.
/// @throws base::InputError if it has both, or for a last frame before the first
FrameRange read_frame_range(base::MapReader& scene);

/// @throws base::InputError if a sequence goes beyond the scene's frames 0 ... frame_count - 1
void check_frame_range(const FrameRange& frames, int frame_count, const std::string& scene);

}  // namespace suites
