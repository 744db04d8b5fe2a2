#include <ostream>

#include "suites/command_line/completions.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/manual_page.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

int run_completions(const CompletionsArguments& arguments, Console& console) {
  const Verbs verbs = all_verbs();
  if (arguments.shell == "bash") console.out << bash_completions(verbs);
  if (arguments.shell == "zsh") console.out << zsh_completions(verbs);
  if (arguments.shell == "fish") console.out << fish_completions(verbs);
  return kAsExpected;
}

int run_man(const ManArguments&, Console& console) {
  console.out << manual_page(all_verbs(), DISCERN_VERSION);
  return kAsExpected;
}

}  // namespace suites::command_line
