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

void end_now(int) { _exit(kInterrupted); }

void stop_soon(int) {
  if (interrupt_requested.exchange(true)) _exit(kInterrupted);
  static constexpr std::string_view kMessage =
      "\ndiscern: interrupted; keeping what is finished (again to end at once)\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
}

}  // namespace

void handle_interrupts(OnInterrupt action) {
  struct sigaction handler {};
  handler.sa_handler = action == OnInterrupt::stop_soon ? stop_soon : end_now;
  handler.sa_flags = SA_RESTART;
  sigemptyset(&handler.sa_mask);
  sigaction(SIGINT, &handler, nullptr);
  sigaction(SIGTERM, &handler, nullptr);
}

}  // namespace suites::command_line
