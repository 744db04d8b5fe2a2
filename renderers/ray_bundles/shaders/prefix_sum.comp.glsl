// Pass: where lists of given lengths begin, one behind the other. Three steps: SUMS of runs of
// numbers, a thread per run; RUNS one behind the other, a single thread; STARTS, a thread per run.
// No barriers: software drivers are slow at them.
// In: counts, of which `most` count at most. Out: starts and the end of the last; totals.

#include "renderers/ray_bundles/shaders/thread_index.glsl"

struct Run {
  uint sum;   // of its counts; then of all runs before it
  uint most;  // greatest count
  uint over;  // sum of what is over `most`
};

layout(std430, binding = 0) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 1) writeonly buffer Starts { uint starts[]; };
layout(std430, binding = 2) buffer Runs { Run runs[]; };
layout(std430, binding = 3) writeonly buffer Totals { Run totals; };

uniform uint count;
uniform uint run_length;
uniform uint run_count;
uniform uint most;

uint saturated(uint a, uint b) { return a > 0xffffffffu - b ? 0xffffffffu : a + b; }

void main() {
  uint index = thread_index();
#if defined(RUNS)
  if (index > 0u) return;
  Run total = Run(0u, 0u, 0u);
  for (uint i = 0u; i < run_count; ++i) {
    Run run = runs[i];
    runs[i].sum = total.sum;
    total = Run(saturated(total.sum, run.sum), max(total.most, run.most),
                saturated(total.over, run.over));
  }
  totals = total;
#else
  if (index >= run_count) return;
  uint end = min(count, (index + 1u) * run_length);
#ifdef SUMS
  Run run = Run(0u, 0u, 0u);
  for (uint i = index * run_length; i < end; ++i) {
    uint here = counts[i];
    run.sum = saturated(run.sum, min(here, most));
    run.most = max(run.most, here);
    run.over = saturated(run.over, here - min(here, most));
  }
  runs[index] = run;
#else
  uint start = runs[index].sum;
  for (uint i = index * run_length; i < end; ++i) {
    starts[i] = start;
    start += min(counts[i], most);
  }
  if (end == count) starts[count] = start;
#endif
#endif
}
