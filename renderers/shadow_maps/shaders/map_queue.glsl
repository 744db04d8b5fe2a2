// Pairs of triangle and layer whose image may cover many texels, in the order they were found
// (which changes nothing: the nearest distance wins).

struct LargePair {
  int triangle;
  int layer;
  uint least;     // texel y << 16 | x
  uint greatest;
};

layout(std430, binding = 5) buffer LargePairs {
  uint large_pairs_found;  // may exceed queue_capacity: the rest was drawn where it was found
  uint small_pairs;        // counted on demand only, as the next two
  uint texels_small;
  uint texels_large;
  LargePair large_pairs[];
};

uniform int queue_capacity;

int queued_pairs() { return int(min(large_pairs_found, uint(queue_capacity))); }
uint pack_texel(ivec2 texel) { return uint(texel.y) << 16 | uint(texel.x); }
ivec2 unpack_texel(uint word) { return ivec2(int(word & 0xffffu), int(word >> 16)); }
