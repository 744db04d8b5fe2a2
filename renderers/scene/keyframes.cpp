#include "renderers/scene/keyframes.h"

#include "renderers/scene/value_reader.h"

#include <fmt/format.h>

#include <limits>

namespace renderers::scene {

void for_each_key(const base::Node& animation,
                  const std::function<void(int frame, base::MapReader& reader)>& read) {
  base::MapReader reader(animation, "animation");
  const base::Node& list = reader.require("keys");
  reader.finish();
  int last_frame = -1;
  for (const base::Node& node : list.list("keys")) {
    base::MapReader key(node, "animation key");
    const base::Node& frame_node = key.require("frame");
    const int frame = read_count(frame_node, "frame", 0, std::numeric_limits<int>::max() - 1);
    if (frame <= last_frame) {
      throw base::InputError(
          frame_node.place(),
          fmt::format("frame {} follows frame {}; frames must increase", frame, last_frame));
    }
    last_frame = frame;
    read(frame, key);
    key.finish();
  }
  if (last_frame < 0) throw base::InputError(list.place(), "animation has no keys");
}

}  // namespace renderers::scene
