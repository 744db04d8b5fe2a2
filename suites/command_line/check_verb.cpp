#include "suites/command_line/plan_output.h"
#include "suites/command_line/psychophysics_verbs.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

int run_check(const CheckArguments& arguments, Console& console) {
  if (is_psychophysics(arguments.selection)) return check_psychophysics(arguments, console);
  const PlannedSuite planned =
      plan_suite(select_suite(arguments.selection), arguments.selection.filter);
  return print_plan(planned, arguments.selection, arguments.results, arguments.json, console);
}

}  // namespace suites::command_line
