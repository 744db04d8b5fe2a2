#pragma once

#include <initializer_list>

namespace suites::command_line {

/// What the process says to the shell (DESIGN section 5).
enum ExitCode : int {
  kAsExpected = 0,
  kGateFailed = 1,
  kInputError = 2,
  kCellsFailed = 3,
  kNothingMeasured = 4,
  kInconclusive = 5,
  kInterrupted = 130
};

/// The code that counts when several apply: 130, 2, 4, 3, 1, 5, 0 in this order.
int most_important(std::initializer_list<int> codes);

}  // namespace suites::command_line
