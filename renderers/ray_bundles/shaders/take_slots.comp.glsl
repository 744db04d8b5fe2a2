// Pass: the slots of a pass into the lines' lists, a thread per line. In: slots; starts of the
// lists. Out: words; per line the least word that the next pass may take.

#include "renderers/ray_bundles/shaders/thread_index.glsl"

layout(std430, binding = 3) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 4) writeonly buffer Words { uint words[]; };
layout(std430, binding = 8) buffer Slots { uint slots[]; };
layout(std430, binding = 9) writeonly buffer FirstWords { uint first_words[]; };

uniform uint line_count;
uniform uint slot_count;
uniform uint pass;

const uint kNoWord = 0xffffffffu;

void main() {
  uint line = thread_index();
  if (line >= line_count) return;
  uint to = starts[line] + pass * slot_count;
  uint end = starts[line + 1u];
  for (uint i = line * slot_count; i < (line + 1u) * slot_count && to < end; ++i, ++to) {
    words[to] = slots[i];
    first_words[line] = slots[i] + 1u;
    slots[i] = kNoWord;
  }
}
