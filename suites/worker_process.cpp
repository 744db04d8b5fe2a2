#include "suites/worker_process.h"

#include <signal.h>

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "perception/base/available_memory.h"
#include "perception/base/errors.h"
#include "perception/base/log_file.h"
#include "perception/base/units.h"

namespace suites {
namespace {

using Seconds = std::chrono::duration<double>;
using Wait = base::ChildProcess::Wait;

/// Time between TERM and KILL for a worker that has to end.
constexpr Seconds kGrace{1.0};
/// Time a worker has to end by itself after "close".
constexpr Seconds kCloseGrace{2.0};
/// What is kept of each log: the first and the last MiB (DESIGN section 4).
constexpr std::int64_t kLogBytesEach = std::int64_t{1} << 20;

}  // namespace

WorkerEnd end_of(const base::ExitState& exit, std::optional<std::int64_t> new_kills,
                 std::int64_t largest_bytes) {
  if (exit.signal != SIGKILL || new_kills == 0) return {results::Status::crash, exit.text()};
  const std::string held = largest_bytes > 0
                               ? fmt::format("; its resident memory had reached {}",
                                             base::format_bytes(static_cast<double>(largest_bytes)))
                               : std::string();
  if (!new_kills) return {results::Status::crash, exit.text() + ", out of memory?" + held};
  return {results::Status::out_of_memory,
          exit.text() + ", and the kernel killed for lack of memory meanwhile" + held};
}

WorkerProcess::WorkerProcess(const WorkerOptions& options, OpenJob open)
    : options_(options), open_(std::move(open)) {
  base::ChildProcess::Options process;
  process.arguments = {options_.executable.string(), "worker"};
  process.stdout_file = options_.stdout_file;
  process.stderr_file = options_.stderr_file;
  process.with_channel = true;
  child_ = std::make_unique<base::ChildProcess>(process);
}

WorkerProcess::~WorkerProcess() { close(); }

std::int64_t WorkerProcess::resident_bytes() const {
  return child_ == nullptr ? 0 : child_->resident_bytes();
}

void WorkerProcess::close() {
  if (child_ == nullptr) return;
  child_->send_line(to_line(Job(CloseJob{})));
  // A worker between jobs ends at once; one in the middle of a job is killed.
  std::string line;
  child_->receive_line(line, kCloseGrace, [] { return true; });
  child_->stop(kGrace);
  child_.reset();
  base::keep_first_and_last(options_.stdout_file, kLogBytesEach);
  base::keep_first_and_last(options_.stderr_file, kLogBytesEach);
}

void WorkerProcess::give_up(WorkerAnswer& answer, Wait wait) {
  using results::Status;
  const bool is_too_large = options_.memory_bytes > 0 && largest_bytes_ > options_.memory_bytes;
  // A process that has ended by itself keeps its exit state; stopping it then only collects it.
  const base::ExitState exit = child_->stop(kGrace);
  child_.reset();
  base::keep_first_and_last(options_.stdout_file, kLogBytesEach);
  base::keep_first_and_last(options_.stderr_file, kLogBytesEach);
  if (is_too_large) {
    answer.status = Status::out_of_memory;
    answer.reason = fmt::format("resident memory reached {}; the limit is {}",
                                base::format_bytes(static_cast<double>(largest_bytes_)),
                                base::format_bytes(static_cast<double>(options_.memory_bytes)));
  } else if (wait == Wait::interrupted) {
    answer.is_interrupted = true;
  } else if (wait == Wait::timeout) {
    answer.status = Status::timeout;
    answer.reason = fmt::format("no answer within {}", base::format_duration(options_.timeout_s));
  } else {
    const std::optional<std::int64_t> kills = base::out_of_memory_kills();
    const bool is_known = kills && kills_before_;
    const WorkerEnd end = end_of(
        exit, is_known ? std::optional(*kills - *kills_before_) : std::nullopt, largest_bytes_);
    answer.status = end.status;
    answer.reason = end.reason;
  }
}

std::optional<Reply> WorkerProcess::ask(const Job& job, WorkerAnswer& answer) {
  largest_bytes_ = 0;
  kills_before_ = base::out_of_memory_kills();
  const auto may_go_on = [&] {
    if (options_.is_interrupted && options_.is_interrupted()) return false;
    largest_bytes_ = std::max(largest_bytes_, child_->resident_bytes());
    return options_.memory_bytes <= 0 || largest_bytes_ <= options_.memory_bytes;
  };
  std::string line;
  Wait wait = Wait::closed;
  if (child_->send_line(to_line(job))) {
    wait = child_->receive_line(line, Seconds(options_.timeout_s), may_go_on);
  }
  if (wait == Wait::line) {
    try {
      return reply_from_line(line);
    } catch (const base::InputError& error) {
      child_->stop(kGrace);
      child_.reset();
      answer.status = results::Status::crash;
      answer.reason = error.what();
      return std::nullopt;
    }
  }
  give_up(answer, wait);
  return std::nullopt;
}

WorkerAnswer WorkerProcess::render(const RenderOrder& order) {
  WorkerAnswer answer;
  const auto refuse = [&](const Reply& reply) {
    const auto* refused = std::get_if<Refused>(&reply);
    answer.status = results::Status::crash;
    answer.reason = refused != nullptr ? refused->reason : "a reply out of order";
  };
  if (!is_open_) {
    const std::optional<Reply> reply = ask(Job(open_), answer);
    if (!reply) return answer;
    is_open_ = std::holds_alternative<Opened>(*reply);
    if (!is_open_) {
      refuse(*reply);
      return answer;
    }
  }
  std::optional<Reply> reply = ask(Job(order), answer);
  if (!reply) return answer;
  if (const auto* not_stored = std::get_if<NotStored>(&*reply)) {
    throw base::InputError(not_stored->reason);
  }
  if (auto* rendered = std::get_if<Rendered>(&*reply)) {
    answer.status = rendered->record.status;
    answer.rendered = std::move(*rendered);
  } else {
    refuse(*reply);
  }
  return answer;
}

}  // namespace suites
