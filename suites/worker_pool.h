#pragma once

#include <memory>
#include <string>
#include <vector>

#include "suites/run_plan.h"
#include "suites/suite_runner.h"
#include "suites/worker_process.h"

namespace suites {

/// Idle workers may hold this many bytes together before the one that waited longest is closed: a
/// quarter of the machine's memory.
std::int64_t idle_memory_bytes();

/// One live worker per (scene, method), made when it is first needed and again after it was lost.
///
/// A worker's output goes to the logs of the cell it was started for; the method's other cells link
/// to them. Empty logs are removed when the worker ends.
class WorkerPool {
 public:
  WorkerPool(const Suite& suite, const RunOptions& options);
  ~WorkerPool();

  /// The worker of the cell's scene and method.
  /// @param cell_folder  images/<cell> of the run
  WorkerProcess& worker(const PlannedCell& cell, const std::filesystem::path& cell_folder);
  void close_all();

 private:
  struct Entry;
  void start(Entry& entry, const std::filesystem::path& cell_folder);
  void close(Entry& entry);
  void link_logs(Entry& entry, const std::filesystem::path& cell_folder);
  void make_room(const Entry& kept);

  const Suite& suite_;
  const RunOptions& options_;
  std::int64_t idle_memory_bytes_;
  std::uint64_t uses_ = 0;
  std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace suites
