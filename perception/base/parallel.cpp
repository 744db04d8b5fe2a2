#include "perception/base/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
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
  // oneTBB runs the pieces after what came before this call and before it returns. Said once more
  // by atomics of our own, which the thread sanitizer sees; those of the library it does not.
  std::atomic<bool> has_begun = false;
  std::atomic<std::size_t> ended = 0;
  has_begun.store(true, std::memory_order_release);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pieces, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        static_cast<void>(has_begun.load(std::memory_order_acquire));
        for (std::size_t piece = range.begin(); piece != range.end(); ++piece) {
          body(piece * grain, std::min(count, (piece + 1) * grain));
        }
        ended.fetch_add(1, std::memory_order_release);
      },
      tbb::simple_partitioner());
  static_cast<void>(ended.load(std::memory_order_acquire));
}

}  // namespace base
