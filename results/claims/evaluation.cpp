#include "results/claims/evaluation.h"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/claims/function_table.h"

namespace results::claims {
namespace {

double apply(char sign, double left, double right) {
  switch (sign) {
    case '+':
      return left + right;
    case '-':
      return left - right;
    case '*':
      return left * right;
    default:
      return left / right;
  }
}

Number negated(const Number& number) {
  return combine(std::span(&number, 1), [](std::span<const double> in) { return -in[0]; });
}

Number operation(char sign, const Number& left, const Number& right) {
  const std::array<const Number*, 2> both{&left, &right};
  return combine(both, [=](std::span<const double> in) { return apply(sign, in[0], in[1]); });
}

std::string labels_of(const Value& value) {
  std::vector<std::string> labels;
  for (const Element& element : value.elements) labels.push_back(element.label);
  return fmt::format("{}", fmt::join(labels, ", "));
}

/// Element by element; of two lists those of the same place must have the same label.
Value operation(const Expression& expression, const Value& left, const Value& right) {
  if (left.is_list && right.is_list && labels_of(left) != labels_of(right)) {
    throw base::InputError(fmt::format("{}: the lists differ: {} and {}", expression.text,
                                       labels_of(left), labels_of(right)));
  }
  Value result = left.is_list ? left : right;
  for (std::size_t i = 0; i < result.elements.size(); ++i) {
    const Element& a = left.elements[left.is_list ? i : 0];
    const Element& b = right.elements[right.is_list ? i : 0];
    result.elements[i].number = operation(expression.sign, a.number, b.number);
  }
  return result;
}

Number elementwise(const Function& function, const Number& number) {
  return combine(std::span(&number, 1),
                 [&](std::span<const double> in) { return function.elementwise(in[0]); });
}

Value evaluate_call(const Expression& call, Evaluation& evaluation) {
  const Function& function = *call.function;
  if (function.elementwise == nullptr) return function.evaluate(call, evaluation);
  Value value = evaluate_expression(call.parts.front(), evaluation);
  for (Element& element : value.elements) element.number = elementwise(function, element.number);
  return value;
}

void collect_stages(const Expression& stages, const RunValues& values,
                    std::vector<Quantity>& found) {
  if (stages.kind == Expression::Kind::quantity) {
    found.push_back(stage_quantity(values, stages.name));
  }
  for (const Expression& part : stages.parts) collect_stages(part, values, found);
}

}  // namespace

Value single_value(Number number) {
  return {{Element{"", std::nullopt, std::move(number)}}, false};
}

Value evaluate_expression(const Expression& expression, Evaluation& evaluation) {
  switch (expression.kind) {
    case Expression::Kind::number:
      return single_value({expression.number, {}, 0, {}});
    case Expression::Kind::call:
      return evaluate_call(expression, evaluation);
    default:
      break;
  }
  Value left = evaluate_expression(expression.parts.front(), evaluation);
  if (expression.parts.size() == 1) {
    for (Element& element : left.elements) element.number = negated(element.number);
    return left;
  }
  return operation(expression, left, evaluate_expression(expression.parts.back(), evaluation));
}

Number evaluate_number(const Expression& expression, Evaluation& evaluation) {
  const Value value = evaluate_expression(expression, evaluation);
  if (!value.is_list) return value.elements.front().number;
  throw base::InputError(fmt::format("{} is a list; a single number is needed, e.g. greatest({})",
                                     expression.text, expression.text));
}

Number evaluate_formula(const Expression& formula, std::size_t row, Evaluation& evaluation) {
  switch (formula.kind) {
    case Expression::Kind::number:
      return {formula.number, {}, 0, {}};
    case Expression::Kind::quantity:
      return evaluation.numbers.estimate(
          row, evaluation.numbers.values().find_quantity(formula.name, {}));
    case Expression::Kind::call:
      return elementwise(*formula.function,
                         evaluate_formula(formula.parts.front(), row, evaluation));
    default:
      break;
  }
  const Number left = evaluate_formula(formula.parts.front(), row, evaluation);
  if (formula.parts.size() == 1) return negated(left);
  return operation(formula.sign, left, evaluate_formula(formula.parts.back(), row, evaluation));
}

std::vector<std::size_t> selected_rows(const Expression& rows, const Evaluation& evaluation) {
  std::vector<std::size_t> selected =
      select_rows(evaluation.numbers.values().rows(), rows.selector, {});
  if (!selected.empty()) return selected;
  throw base::InputError(fmt::format("no row of this run is {}", rows.selector.text));
}

Quantity stage_quantity(const RunValues& values, const std::string& name) {
  constexpr std::string_view kFirst = "first.";
  constexpr std::string_view kStage = "stage.";
  std::string path = name;
  const bool is_first = path.starts_with(kFirst);
  if (is_first) path.erase(0, kFirst.size());
  if (!path.starts_with(kStage)) path.insert(0, kStage);
  Quantity stage = values.find_quantity((is_first ? std::string(kFirst) : "") + path, {});
  stage.text = name;
  return stage;
}

std::vector<Quantity> stages_of(const Expression& stages, const Evaluation& evaluation) {
  std::vector<Quantity> found;
  collect_stages(stages, evaluation.numbers.values(), found);
  return found;
}

void add_part(Evaluation& evaluation, const std::string& text, const Number& number,
              std::size_t rows) {
  evaluation.parts.push_back({text, number.value, interval_of(number), rows});
}

}  // namespace results::claims
