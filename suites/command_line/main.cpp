#include "suites/command_line/command_line.h"

int main(int argc, char** argv) {
  auto console = suites::command_line::process_console();
  return suites::command_line::run_command_line({argv + 1, argv + argc}, console);
}
