#include "perception/base/parallel.h"

#include <sched.h>

#include <algorithm>
#include <cassert>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace base {

int core_count() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

struct ThreadLimit::Control {
  explicit Control(int threads)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : threads_(threads > 0 ? threads : core_count()),
      control_(std::make_unique<Control>(threads_)) {}

ThreadLimit::~ThreadLimit() = default;

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  assert(grain > 0);
  const std::size_t pieces = (count + grain - 1) / grain;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pieces, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t piece = range.begin(); piece != range.end(); ++piece) {
          body(piece * grain, std::min(count, (piece + 1) * grain));
        }
      },
      tbb::simple_partitioner());
}

}  // namespace base
