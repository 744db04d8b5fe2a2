#pragma once

#include "perception/base/document.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

/// Values that change over the frames of a scene.
namespace renderers::scene {

template <typename Value>
struct Key {
  int frame = 0;
  Value value{};
};

/// A value at every frame: at rest (one key) or moved by the keys of an `animation:`.
template <typename Value>
struct Track {
  std::vector<Key<Value>> keys;  ///< at least one, frames strictly increasing
  bool is_animated = false;

  int last_frame() const { return keys.back().frame; }

  /// Frames outside the keys hold the nearest key.
  /// @param mix  mix(a, b, t), t in (0, 1)
  template <typename Mix>
  Value at(int frame, const Mix& mix) const {
    const auto after = std::ranges::upper_bound(keys, frame, {}, &Key<Value>::frame);
    if (after == keys.begin()) return keys.front().value;
    const Key<Value>& before = *(after - 1);
    if (after == keys.end() || before.frame == frame) return before.value;
    const float t =
        static_cast<float>(frame - before.frame) / static_cast<float>(after->frame - before.frame);
    return mix(before.value, after->value, t);
  }
};

/// Calls `read` for each map of {keys: [{frame, ...}, ...]} with its frame; what `read` does not
/// ask for is refused.
/// @throws base::InputError unless frames are whole, >= 0 and strictly increasing, at least one key
void for_each_key(const base::Node& animation,
                  const std::function<void(int frame, base::MapReader& reader)>& read);

/// The track of a map with an optional `animation`.
/// @param rest      the value without animation; keys take from it what they leave out
/// @param read_key  reads the values of a key over `rest`: Value(MapReader&, Value)
template <typename Value, typename ReadKey>
Track<Value> read_track(base::MapReader& reader, const Value& rest, const ReadKey& read_key) {
  const base::Node* animation = reader.find("animation");
  if (animation == nullptr) return {{{0, rest}}, false};
  Track<Value> track{{}, true};
  for_each_key(*animation, [&](int frame, base::MapReader& key) {
    track.keys.push_back({frame, read_key(key, rest)});
  });
  return track;
}

}  // namespace renderers::scene
