#include "results/claims/expression.h"

#include <algorithm>

#include "results/claims/function_table.h"

namespace results::claims {

bool gives_list(const Expression& expression) {
  if (expression.kind == Expression::Kind::call) {
    if (expression.function->makes_list) return true;
    if (expression.function->elementwise == nullptr) return false;
  }
  return std::any_of(expression.parts.begin(), expression.parts.end(), gives_list);
}

}  // namespace results::claims
