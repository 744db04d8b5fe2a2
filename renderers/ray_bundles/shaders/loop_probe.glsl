// Mesa's software drivers end the loops of a thread after 65,535 turns of all together, without a
// word: each later loop ends after its first turn.

uniform uint probe_turns;  // 2; not a constant, which would be unrolled

// True if loops before have been ended so; of all threads that run in one vector.
bool are_loops_cut_off() {
  uint turns = 0u;
  for (; turns < probe_turns; ++turns) {}
  return turns < probe_turns;
}
