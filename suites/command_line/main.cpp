#include <csignal>

#include "suites/command_line/command_line.h"

int main(int argc, char** argv) {
  // A file that may not grow is an error of who writes it, as a full disk is; workers inherit this.
  std::signal(SIGXFSZ, SIG_IGN);
  auto console = suites::command_line::process_console();
  return suites::command_line::run_command_line({argv + 1, argv + argc}, console);
}
