#include "suites/command_line/plan_output.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

int run_check(const CheckArguments& arguments, Console& console) {
  const PlannedSuite planned =
      plan_suite(select_suite(arguments.selection), arguments.selection.filter);
  return print_plan(planned, arguments.results, arguments.json, console);
}

}  // namespace suites::command_line
