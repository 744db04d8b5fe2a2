#pragma once

namespace suites::command_line {

/// What the first Ctrl-C (SIGINT) or SIGTERM does; the second one always ends the process at once.
enum class OnInterrupt {
  stop_soon,         ///< sets suites::interrupt_requested: what is finished is kept
  end_now,           ///< ends the process with code 130
  end_now_with_json  ///< same, with one JSON object on stdout
};

/// The file descriptor that `end_now_with_json` writes to; stdout until it is moved.
void answer_interrupts_on(int fd);

/// Installs the signal handlers.
void handle_interrupts(OnInterrupt action);

}  // namespace suites::command_line
