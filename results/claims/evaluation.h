#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "results/claims/claim.h"
#include "results/claims/expression.h"
#include "results/claims/row_numbers.h"

namespace results::claims {

/// One of the values of an expression.
struct Element {
  std::string label;        ///< "30" of a series over vals; "" of a single value
  std::optional<double> x;  ///< if the label is a number
  Number number;
};

/// What an expression gives: one element, or those of a list.
struct Value {
  std::vector<Element> elements;
  bool is_list = false;
};
Value single_value(Number number);

/// A number behind a claim, in the order of evaluation.
struct ClaimPart {
  std::string text;
  double value = 0.0;
  std::optional<Interval> interval;
  std::size_t rows = 0;  ///< that it is of
};

/// What the evaluation of a claim shares.
struct Evaluation {
  RowNumbers& numbers;
  std::vector<ClaimPart> parts;
  BelowNoise below_noise = BelowNoise::counts;
  std::set<std::string> left_out;  ///< rows at the noise of their references
};

/// @throws base::InputError with the reason if it has no value: no rows, no samples, a name that
///   does not exist
Value evaluate_expression(const Expression& expression, Evaluation& evaluation);
/// The value of an argument that must be one number.
Number evaluate_number(const Expression& expression, Evaluation& evaluation);
/// A formula of a row's quantities.
Number evaluate_formula(const Expression& formula, std::size_t row, Evaluation& evaluation);
/// At least one. @param rows  an argument of that kind
std::vector<std::size_t> selected_rows(const Expression& rows, const Evaluation& evaluation);

/// The quantity of a name that stands for a stage.
Quantity stage_quantity(const RunValues& values, const std::string& name);
/// The stages of an argument of kind `stages`.
std::vector<Quantity> stages_of(const Expression& stages, const Evaluation& evaluation);

/// Keeps the number as one that the claim rests on.
void add_part(Evaluation& evaluation, const std::string& text, const Number& number,
              std::size_t rows);

}  // namespace results::claims
