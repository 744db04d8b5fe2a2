#include "suites/frame_range.h"

#include <fmt/format.h>

namespace suites {
namespace {

/// Largest frame number: more is a slip of the pen.
constexpr std::int64_t kMaxFrame = 1000000;

int bounded(const base::Node& node, const char* what, std::int64_t low) {
  const std::int64_t value = node.integer(what);
  if (value < low || value > kMaxFrame) {
    throw base::InputError(
        node.place(), fmt::format("{} is {}; accepted: {} to {}", what, value, low, kMaxFrame));
  }
  return static_cast<int>(value);
}

/// The values of `frames`, each by itself in range.
void read_sequence(const base::Node& node, FrameRange& frames) {
  if (node.is_list() && node.list("frames").size() == 2) {
    frames.first = bounded(node.list("frames")[0], "first", 0);
    frames.last = bounded(node.list("frames")[1], "last", 0);
    return;
  }
  if (!node.is_map()) {
    throw base::InputError(node.place(),
                           "frames must be [first, last] or {first, last, step}, e.g. [0, 59]");
  }
  base::MapReader reader(node, "frames");
  frames.first = bounded(reader.require("first"), "first", 0);
  frames.last = bounded(reader.require("last"), "last", 0);
  if (const base::Node* step = reader.find("step")) frames.step = bounded(*step, "step", 1);
  reader.finish();
}

}  // namespace

std::vector<int> FrameRange::numbers() const {
  std::vector<int> frames;
  for (int frame = first; frame <= last; frame += step) frames.push_back(frame);
  return frames;
}

FrameRange read_frame_range(base::MapReader& scene) {
  FrameRange frames;
  const base::Node* single = scene.find("frame");
  const base::Node* sequence = scene.find("frames");
  if (single != nullptr && sequence != nullptr) {
    throw base::InputError(scene.node().key_place("frames"),
                           "a scene has either frame or frames; found both");
  }
  if (single != nullptr) {
    frames.place = single->place();
    frames.first = frames.last = bounded(*single, "frame", 0);
  }
  if (sequence == nullptr) return frames;
  frames.place = sequence->place();
  frames.is_sequence = true;
  read_sequence(*sequence, frames);
  if (frames.last < frames.first) {
    throw base::InputError(
        sequence->place(),
        fmt::format("the last of frames, {}, is before the first, {}", frames.last, frames.first));
  }
  return frames;
}

void check_frame_range(const FrameRange& frames, int frame_count, const std::string& scene) {
  if (!frames.is_sequence || frames.last < frame_count) return;
  throw base::InputError(frames.place,
                         fmt::format("frames go to {}; accepted: 0 to {}, the frames of scene "
                                     "\"{}\"",
                                     frames.last, frame_count - 1, scene));
}

}  // namespace suites
