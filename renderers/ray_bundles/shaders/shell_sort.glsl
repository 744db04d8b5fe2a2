// Sorts a part of a buffer in place. Shell's sort with gaps (3^n - 1) / 2 (Knuth 1998, The Art of
// Computer Programming 3, Sec. 5.2.1, recalled); short lists by insertion. The file that includes
// this one defines ahead of it: SORTED_TYPE of the items, SORTED, the buffer's array, and
// COMES_BEFORE(a, b).

void sort(uint begin, uint end) {
  const uint kMostInserted = 24u;
  uint gap = 1u;
  if (end - begin > kMostInserted) {
    while (3u * gap + 1u < end - begin) gap = 3u * gap + 1u;
  }
  for (; gap > 0u; gap = (gap - 1u) / 3u) {
    for (uint i = begin + gap; i < end; ++i) {
      SORTED_TYPE moved = SORTED[i];
      uint place = i;
      for (; place >= begin + gap; place -= gap) {
        SORTED_TYPE before = SORTED[place - gap];
        if (!(COMES_BEFORE(moved, before))) break;
        SORTED[place] = before;
      }
      SORTED[place] = moved;
    }
  }
}
