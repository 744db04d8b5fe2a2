#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "perception/base/child_process.h"
#include "suites/worker_protocol.h"

namespace suites {

/// How a worker is started and what it may use.
struct WorkerOptions {
  std::filesystem::path executable;   ///< started as `<executable> worker`
  std::filesystem::path stdout_file;  ///< appended to
  std::filesystem::path stderr_file;
  double timeout_s = 600.0;              ///< of one job, the opening included
  std::int64_t memory_bytes = 0;         ///< of resident memory; <= 0: no limit
  std::function<bool()> is_interrupted;  ///< asked about every 50 ms; may be empty
};

/// How a repetition ended, seen from the harness.
struct WorkerAnswer {
  bool is_interrupted = false;  ///< nothing else is set then
  /// Set if the worker answered; else `status` and `reason` say what became of it.
  std::optional<Rendered> rendered;
  results::Status status = results::Status::ok;
  std::string reason;
};

/// What the end of a worker that gave no answer says.
struct WorkerEnd {
  results::Status status = results::Status::crash;
  std::string reason;
};

/// KILL comes from outside: of the kernel, if it killed for lack of memory meanwhile.
/// @param new_kills      `base::out_of_memory_kills` since the worker was asked; nothing: not known
/// @param largest_bytes  resident memory it was seen with; 0: none was seen
WorkerEnd end_of(const base::ExitState& exit, std::optional<std::int64_t> new_kills,
                 std::int64_t largest_bytes);

/// The harness's side of one worker process. A worker that crashed, hung or grew too large is gone
/// after the answer that says so; make a new one then.
class WorkerProcess {
 public:
  /// Starts the process; it opens its scene with the first repetition.
  /// @throws base::DeviceError if it cannot be started
  WorkerProcess(const WorkerOptions& options, OpenJob open);
  ~WorkerProcess();

  /// Runs one repetition to its end, whatever that is.
  WorkerAnswer render(const RenderOrder& order);

  bool is_alive() const { return child_ != nullptr; }
  pid_t pid() const { return child_ == nullptr ? -1 : child_->pid(); }
  std::int64_t resident_bytes() const;
  /// Asks the worker to end, then makes it.
  void close();

 private:
  /// Sends a job and waits for its reply; nothing if the worker had to be given up, see `answer`.
  std::optional<Reply> ask(const Job& job, WorkerAnswer& answer);
  void give_up(WorkerAnswer& answer, base::ChildProcess::Wait wait);

  WorkerOptions options_;
  OpenJob open_;
  std::unique_ptr<base::ChildProcess> child_;
  bool is_open_ = false;
  std::int64_t largest_bytes_ = 0;
  std::optional<std::int64_t>
      kills_before_;  ///< `base::out_of_memory_kills` when it was last asked
};

}  // namespace suites
