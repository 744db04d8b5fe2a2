#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace base {

/// Limits the threads of `parallel_for` and of every library on the same scheduler while it lives.
///
/// @param threads  >= 1, or 0 for one per core
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  int threads() const { return threads_; }

 private:
  struct Control;
  int threads_;
  std::unique_ptr<Control> control_;
};

/// Cores this process may run on (its affinity mask), at least 1.
int core_count();

/// Calls body(begin, end) over disjoint pieces of [0, count), in parallel; returns when all ended.
///
/// Pieces hold at most `grain` indices and always begin at multiples of it, so a body that
/// reduces per piece gives the same sums with every number of threads.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace base
