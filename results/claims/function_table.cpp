#include "results/claims/function_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "results/claims/row_functions.h"

namespace results::claims {
namespace {

using Kind = ArgumentKind;

/// All values of the arguments, those of lists too.
Value reduced(const Expression& call, Evaluation& evaluation,
              double (*reduction)(std::span<const double>)) {
  std::vector<Number> numbers;
  for (const Expression& part : call.parts) {
    for (Element& element : evaluate_expression(part, evaluation).elements) {
      numbers.push_back(std::move(element.number));
    }
  }
  return single_value(reduce(numbers, reduction));
}

Value greatest(const Expression& call, Evaluation& evaluation) {
  return reduced(call, evaluation, [](std::span<const double> values) {
    return *std::max_element(values.begin(), values.end());
  });
}

Value least(const Expression& call, Evaluation& evaluation) {
  return reduced(call, evaluation, [](std::span<const double> values) {
    return *std::min_element(values.begin(), values.end());
  });
}

Value ratio(const Expression& call, Evaluation& evaluation) {
  const std::array<Number, 2> both{evaluate_number(call.parts.front(), evaluation),
                                   evaluate_number(call.parts.back(), evaluation)};
  return single_value(combine(both, [](std::span<const double> in) { return in[0] / in[1]; }));
}

/// A line per function; the order is that of messages and of the README.
const std::vector<Function> kFunctions{
    {"value",
     {Kind::rows, Kind::formula},
     "value(rows, formula)",
     "the estimate of exactly one row",
     value_of_row},
    {"median",
     {Kind::rows, Kind::formula},
     "median(rows, formula)",
     "median over the rows' estimates",
     median_over_rows},
    {"mean",
     {Kind::rows, Kind::formula},
     "mean(rows, formula)",
     "mean over the rows' estimates",
     mean_over_rows},
    {"min",
     {Kind::rows, Kind::formula},
     "min(rows, formula)",
     "least of the rows' estimates",
     min_over_rows},
    {"max",
     {Kind::rows, Kind::formula},
     "max(rows, formula)",
     "greatest of the rows' estimates",
     max_over_rows},
    {"sum",
     {Kind::rows, Kind::formula},
     "sum(rows, formula)",
     "sum of the rows' estimates",
     sum_over_rows},
    {"count", {Kind::rows}, "count(rows)", "rows with at least one success", count_of_rows},
    {"last",
     {Kind::rows, Kind::quantity},
     "last(rows, quantity)",
     "one row's value at the end: of the last frame, the last of a series",
     last_of_row},
    {"quantile",
     {Kind::rows, Kind::quantity, Kind::number},
     "quantile(rows, quantity, p)",
     "quantile of all samples of the rows: frames, elements of series, repetitions",
     quantile_of_samples},
    {"share_of",
     {Kind::rows, Kind::condition},
     "share_of(rows, quantity >= 30)",
     "share of all samples of the rows that meet a condition",
     share_of_samples},
    {"share",
     {Kind::rows, Kind::stages},
     "share(rows, stage + stage)",
     "part of total_s (next_frame_s in a sequence) that stages take, paired by repetition",
     share_of_time},
    {"series",
     {Kind::rows, Kind::formula, Kind::axis},
     "series(rows, formula, x)",
     "the list of the rows' estimates by x; one row per x",
     series_over,
     nullptr,
     true},
    {"argmin",
     {Kind::rows, Kind::formula, Kind::formula},
     "argmin(rows, formula, x)",
     "x of the row with the least estimate",
     argmin_over_rows},
    {"argmax",
     {Kind::rows, Kind::formula, Kind::formula},
     "argmax(rows, formula, x)",
     "x of the row with the greatest estimate",
     argmax_over_rows},
    {"smallest",
     {Kind::rows, Kind::formula, Kind::condition},
     "smallest(rows, x, formula <= 0.02)",
     "smallest x whose rows all meet the condition",
     smallest_that_meets},
    {"least_at",
     {Kind::rows, Kind::formula, Kind::formula, Kind::value},
     "least_at(rows, cost, score, bound)",
     "least cost of the rows whose score is at most the bound: a sweep at equal error",
     least_at_error},
    {"slope",
     {Kind::rows, Kind::formula, Kind::formula},
     "slope(rows, y, x)",
     "slope of the line of least squares, a point per row",
     slope_over_rows},
    {"loglog_slope",
     {Kind::rows, Kind::formula, Kind::formula},
     "loglog_slope(rows, y, x)",
     "the same of log y over log x",
     loglog_slope_over_rows},
    {"r2",
     {Kind::rows, Kind::formula, Kind::formula},
     "r2(rows, y, x)",
     "coefficient of determination of that line, of at least 3 rows",
     r2_over_rows},
    {"spearman",
     {Kind::rows, Kind::formula, Kind::formula},
     "spearman(rows, y, x)",
     "Spearman's rank correlation, of at least 3 rows",
     spearman_over_rows},
    {"error_at",
     {Kind::rows, Kind::quantity, Kind::number},
     "error_at(rows, score, seconds)",
     "one row's score after so many seconds, on the curve of its checkpoints",
     score_at_time_of_row},
    {"time_to",
     {Kind::rows, Kind::quantity, Kind::number},
     "time_to(rows, score, value)",
     "seconds until one row's curve reaches a score; geometric mean over seeds",
     time_to_score_of_row},
    {"ratio", {Kind::value, Kind::value}, "ratio(a, b)", "a / b", ratio},
    {"greatest",
     {Kind::values},
     "greatest(a, b, ...)",
     "greatest of all values, lists included",
     greatest,
     nullptr,
     false,
     true},
    {"least",
     {Kind::values},
     "least(a, b, ...)",
     "least of all values, lists included",
     least,
     nullptr,
     false,
     true},
    {"abs",
     {Kind::value},
     "abs(a)",
     "absolute value; of a list, of each",
     nullptr,
     [](double value) { return std::abs(value); }},
    {"sqrt",
     {Kind::value},
     "sqrt(a)",
     "square root",
     nullptr,
     [](double value) { return std::sqrt(value); }},
    {"log2",
     {Kind::value},
     "log2(a)",
     "binary logarithm",
     nullptr,
     [](double value) { return std::log2(value); }},
};

}  // namespace

std::span<const Function> function_table() { return kFunctions; }

const Function* find_function(std::string_view name) {
  const auto found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                  [&](const Function& function) { return function.name == name; });
  return found == kFunctions.end() ? nullptr : &*found;
}

}  // namespace results::claims
