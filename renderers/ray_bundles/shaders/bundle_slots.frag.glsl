// Pass: a k-buffer. Of the crossings of a line that no pass before has taken, the k drawn first
// stay, in this order, whatever order the device runs its fragments in: each hands the greater word
// on to the next slot. In: fragments; per line the least word that is not taken. In, out: slots,
// kNoWord where they are free; crossings per line, of all passes.
// Source: Hermes et al. 2010, Sec. 4.2; the chain of atomic minima is ours.

layout(std430, binding = 2) buffer Counts { uint counts[]; };
layout(std430, binding = 8) buffer Slots { uint slots[]; };
layout(std430, binding = 9) readonly buffer FirstWords { uint first_words[]; };

layout(location = 0) flat in uint triangle;

uniform int width_px;
uniform uint slot_count;  // k

const uint kNoWord = 0xffffffffu;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint line = uint(pixel.y * width_px + pixel.x);
  atomicAdd(counts[line], 1u);
  uint word = 2u * triangle + uint(gl_FrontFacing);
  if (word < first_words[line]) return;
  for (uint i = line * slot_count; i < (line + 1u) * slot_count; ++i) {
    word = max(word, atomicMin(slots[i], word));
    if (word == kNoWord) return;
  }
}
