#include <ostream>

#include <nlohmann/json.hpp>

#include "suites/command_line/exit_codes.h"
#include "suites/command_line/schemas.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

int run_schema(const SchemaArguments& arguments, Console& console) {
  print_json(console, schema(arguments.name));
  return kAsExpected;
}

}  // namespace suites::command_line
