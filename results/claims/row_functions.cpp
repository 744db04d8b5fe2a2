#include "results/claims/row_functions.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "perception/base/quantile.h"
#include "results/claims/reference_noise.h"

namespace results::claims {
namespace {

using Reduction = double (*)(std::span<const double> values);

/// Names of rows for a message: the first few.
std::string some_names(const std::vector<std::size_t>& rows, const Evaluation& evaluation) {
  constexpr std::size_t kMostNames = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(rows.size(), kMostNames); ++i) {
    names += (i == 0 ? "" : ", ") + evaluation.numbers.row_name(rows[i]);
  }
  return rows.size() > kMostNames ? names + ", ..." : names;
}

Value kept(const Expression& call, Evaluation& evaluation, Number number, std::size_t rows) {
  add_part(evaluation, call.text, number, rows);
  return single_value(std::move(number));
}

/// A formula of every selected row, and what is made of them.
Value over_rows(const Expression& call, Evaluation& evaluation, Reduction reduction) {
  const std::vector<std::size_t> rows = counted_rows(call, evaluation);
  std::vector<Number> numbers;
  for (const std::size_t row : rows) {
    numbers.push_back(evaluate_formula(call.parts.back(), row, evaluation));
  }
  return kept(call, evaluation, reduce(numbers, reduction), rows.size());
}

double sum_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

Quantity quantity_of(const Expression& argument, const Evaluation& evaluation) {
  return evaluation.numbers.values().find_quantity(argument.name, {});
}

/// The place of a row on an axis: its key's value, else the formula's.
Element place_on_axis(const Expression& axis, std::size_t row, Evaluation& evaluation) {
  if (axis.kind == Expression::Kind::quantity) {
    const base::ParameterValue* value = evaluation.numbers.values().rows()[row].find(axis.name);
    if (value != nullptr) return {text_of(*value), number_of(*value), {}};
  }
  const double x = evaluate_formula(axis, row, evaluation).value;
  return {fmt::format("{:.6g}", x), x, {}};
}

}  // namespace

std::size_t single_row(const Expression& call, const Evaluation& evaluation) {
  const std::vector<std::size_t> rows = selected_rows(call.parts.front(), evaluation);
  if (rows.size() == 1) return rows.front();
  throw base::InputError(fmt::format("{} needs exactly one row; {} are {}: {}", call.text,
                                     rows.size(), call.parts.front().text,
                                     some_names(rows, evaluation)));
}

Value value_of_row(const Expression& call, Evaluation& evaluation) {
  const std::size_t row = counted_rows(call, {single_row(call, evaluation)}, evaluation).front();
  return kept(call, evaluation, evaluate_formula(call.parts.back(), row, evaluation), 1);
}

Value median_over_rows(const Expression& call, Evaluation& evaluation) {
  return over_rows(call, evaluation, base::median);
}

Value mean_over_rows(const Expression& call, Evaluation& evaluation) {
  return over_rows(call, evaluation, [](std::span<const double> values) {
    return sum_of(values) / static_cast<double>(values.size());
  });
}

Value min_over_rows(const Expression& call, Evaluation& evaluation) {
  return over_rows(call, evaluation, [](std::span<const double> values) {
    return *std::min_element(values.begin(), values.end());
  });
}

Value max_over_rows(const Expression& call, Evaluation& evaluation) {
  return over_rows(call, evaluation, [](std::span<const double> values) {
    return *std::max_element(values.begin(), values.end());
  });
}

Value sum_over_rows(const Expression& call, Evaluation& evaluation) {
  return over_rows(call, evaluation, sum_of);
}

Value count_of_rows(const Expression& call, Evaluation& evaluation) {
  const std::vector<std::size_t> rows = selected_rows(call.parts.front(), evaluation);
  const std::vector<SummaryRow>& summaries = evaluation.numbers.values().summary().rows;
  const auto count = std::count_if(rows.begin(), rows.end(), [&](std::size_t row) {
    return std::any_of(summaries[row].statuses.begin(), summaries[row].statuses.end(),
                       [](const auto& entry) { return is_success(entry.first); });
  });
  return kept(call, evaluation, {static_cast<double>(count), {}, 0, {}}, rows.size());
}

Value last_of_row(const Expression& call, Evaluation& evaluation) {
  const std::size_t row = counted_rows(call, {single_row(call, evaluation)}, evaluation).front();
  const Quantity quantity = quantity_of(call.parts.back(), evaluation);
  return kept(call, evaluation, evaluation.numbers.last(row, quantity), 1);
}

Value quantile_of_samples(const Expression& call, Evaluation& evaluation) {
  const std::vector<std::size_t> rows = counted_rows(call, evaluation);
  const Quantity quantity = quantity_of(call.parts[1], evaluation);
  const double q = call.parts.back().number;
  if (!(q >= 0.0 && q <= 1.0)) {
    throw base::InputError(fmt::format("{}: {} is no quantile; accepted: 0 ... 1", call.text, q));
  }
  return kept(call, evaluation, evaluation.numbers.quantile(rows, quantity, q), rows.size());
}

Value share_of_samples(const Expression& call, Evaluation& evaluation) {
  const std::vector<std::size_t> rows = counted_rows(call, evaluation);
  const Expression& condition = call.parts.back();
  const Quantity quantity = quantity_of(condition.parts.front(), evaluation);
  const auto is_met = [&](double value) {
    return holds(value, condition.relation, condition.number);
  };
  return kept(call, evaluation, evaluation.numbers.share_of(rows, quantity, is_met), rows.size());
}

Number median_share(std::span<const std::size_t> rows, std::span<const Quantity> stages,
                    bool lacks_none, Evaluation& evaluation) {
  std::vector<Number> shares;
  for (const std::size_t row : rows) {
    shares.push_back(evaluation.numbers.share(row, stages, lacks_none));
  }
  return reduce(shares, base::median);
}

Value share_of_time(const Expression& call, Evaluation& evaluation) {
  const std::vector<std::size_t> rows = selected_rows(call.parts.front(), evaluation);
  const std::vector<Quantity> stages = stages_of(call.parts.back(), evaluation);
  return kept(call, evaluation, median_share(rows, stages, true, evaluation), rows.size());
}

Value series_over(const Expression& call, Evaluation& evaluation) {
  Value series;
  series.is_list = true;
  for (const std::size_t row : counted_rows(call, evaluation)) {
    Element element = place_on_axis(call.parts.back(), row, evaluation);
    for (const Element& other : series.elements) {
      if (other.label != element.label) continue;
      throw base::InputError(fmt::format("{}: several rows have {} = {}; narrow {}", call.text,
                                         call.parts.back().text, element.label,
                                         call.parts.front().text));
    }
    element.number = evaluate_formula(call.parts[1], row, evaluation);
    series.elements.push_back(std::move(element));
  }
  const bool has_numbers =
      std::all_of(series.elements.begin(), series.elements.end(),
                  [](const Element& element) { return element.x.has_value(); });
  if (has_numbers) {
    std::stable_sort(series.elements.begin(), series.elements.end(),
                     [](const Element& a, const Element& b) { return *a.x < *b.x; });
  }
  for (const Element& element : series.elements) {
    add_part(evaluation,
             fmt::format("{} at {} = {}", call.text, call.parts.back().text, element.label),
             element.number, 1);
  }
  return series;
}

}  // namespace results::claims
