#include "renderers/contract/frame_counters.h"

#include <algorithm>
#include <cassert>

namespace renderers {

void add_to_counter(std::string_view name, double value, Frame& frame) {
  const auto found =
      std::ranges::find(frame.counters, name, [](const auto& counter) { return counter.first; });
  assert(found != frame.counters.end());
  found->second = std::get<double>(found->second) + value;
}

}  // namespace renderers
