#include "suites/command_line/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <string_view>

#include "suites/command_line/exit_codes.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

namespace {

// Handlers may only call async-signal-safe functions: _exit, write and lock-free atomics.
static_assert(std::atomic<bool>::is_always_lock_free);

void write_text(int fd, std::string_view text) {
  [[maybe_unused]] const auto written = write(fd, text.data(), text.size());
}

/// Where the JSON of an interrupted verb goes; signal handlers can reach nothing but statics.
std::atomic<int> answer_fd{STDOUT_FILENO};

void end_now(int) {
  write_text(STDERR_FILENO, "\ndiscern: interrupted; nothing was written\n");
  _exit(kInterrupted);
}

/// One JSON object on stdout, also on failure.
void end_now_with_json(int) {
  write_text(answer_fd,
             "{\"schema\": 1, \"status\": \"interrupted\", \"reason\": \"interrupted\", "
             "\"exit_code\": 130}\n");
  _exit(kInterrupted);
}

void stop_soon(int) {
  if (interrupt_requested.exchange(true)) _exit(kInterrupted);
  write_text(STDERR_FILENO,
             "\ndiscern: interrupted; keeping what is finished (again to end at once)\n");
}

}  // namespace

void answer_interrupts_on(int fd) { answer_fd = fd; }

void handle_interrupts(OnInterrupt action) {
  struct sigaction handler {};
  switch (action) {
    case OnInterrupt::stop_soon:
      handler.sa_handler = stop_soon;
      break;
    case OnInterrupt::end_now:
      handler.sa_handler = end_now;
      break;
    case OnInterrupt::end_now_with_json:
      handler.sa_handler = end_now_with_json;
      break;
  }
  handler.sa_flags = SA_RESTART;
  sigemptyset(&handler.sa_mask);
  sigaction(SIGINT, &handler, nullptr);
  sigaction(SIGTERM, &handler, nullptr);
}

}  // namespace suites::command_line
