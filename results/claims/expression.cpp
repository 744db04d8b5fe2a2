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

bool holds(double left, RowCondition::Relation relation, double right) {
  using Relation = RowCondition::Relation;
  switch (relation) {
    case Relation::equal:
      return left == right;
    case Relation::unequal:
      return left != right;
    case Relation::less:
      return left < right;
    case Relation::less_or_equal:
      return left <= right;
    case Relation::greater:
      return left > right;
    case Relation::greater_or_equal:
      return left >= right;
  }
  return false;
}

}  // namespace results::claims
