// Pass: the slots of a pass into the lines' lists, a thread per line. In: slots; fragments counted
// so far; starts of the lists. Out: words; per line the least word that the next pass may take;
// number of lines of which this pass has drawn other fragments than the first has counted.

#include "renderers/ray_bundles/shaders/thread_index.glsl"

layout(std430, binding = 2) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 3) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 4) writeonly buffer Words { uint words[]; };
layout(std430, binding = 8) buffer Slots { uint slots[]; };
layout(std430, binding = 9) writeonly buffer FirstWords { uint first_words[]; };
layout(std430, binding = 10) buffer Faults { uint faults; };

uniform uint line_count;
uniform uint slot_count;
uniform uint pass;
uniform int until_complete;

const uint kNoWord = 0xffffffffu;

void main() {
  uint line = thread_index();
  if (line >= line_count) return;
  uint to = starts[line] + pass * slot_count;
  uint end = starts[line + 1u];
  // Every pass counts all fragments anew.
  bool is_faulty = until_complete != 0 && counts[line] != (pass + 1u) * (end - starts[line]);
  for (uint i = line * slot_count; i < (line + 1u) * slot_count && to < end; ++i, ++to) {
    uint word = slots[i];
    if (word == kNoWord) {
      is_faulty = true;
      words[to] = 0u;  // a place that there is, until the host has seen the fault
      continue;
    }
    words[to] = word;
    first_words[line] = word + 1u;
    slots[i] = kNoWord;
  }
  if (is_faulty) atomicAdd(faults, 1u);
}
