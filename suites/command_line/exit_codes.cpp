#include "suites/command_line/exit_codes.h"

#include <algorithm>
#include <array>

namespace suites::command_line {

int most_important(std::initializer_list<int> codes) {
  static constexpr std::array<int, 6> kOrder = {kInterrupted, kInputError, kNothingMeasured,
                                                kCellsFailed, kGateFailed, kInconclusive};
  for (const int code : kOrder) {
    if (std::find(codes.begin(), codes.end(), code) != codes.end()) return code;
  }
  return kAsExpected;
}

}  // namespace suites::command_line
