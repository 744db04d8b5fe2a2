#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "results/claims/reference_noise.h"
#include "results/claims/row_functions.h"
#include "results/statistics.h"

namespace results::claims {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A number of the points (x, y) of the rows. @param x, y  of one length
using Fit = double (*)(std::span<const double> x, std::span<const double> y);

bool is_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

/// One point per row. @param fewest  points that the fit says anything of
Value fit_over_rows(const Expression& call, Evaluation& evaluation, std::size_t fewest, Fit fit) {
  const std::vector<std::size_t> rows = counted_rows(call, evaluation);
  if (rows.size() < fewest) {
    throw base::InputError(fmt::format("{} needs at least {} rows; {} selects {}", call.text,
                                       fewest, call.parts.front().text, rows.size()));
  }
  // The y of all rows, then their x.
  std::vector<Number> numbers;
  for (const std::size_t part : {std::size_t{1}, std::size_t{2}}) {
    for (const std::size_t row : rows) {
      numbers.push_back(evaluate_formula(call.parts[part], row, evaluation));
    }
  }
  Number number = combine(numbers, [&](std::span<const double> values) {
    if (!is_finite(values)) return kNan;
    return fit(values.subspan(rows.size()), values.first(rows.size()));
  });
  add_part(evaluation, call.text, number, rows.size());
  return single_value(std::move(number));
}

double slope(std::span<const double> x, std::span<const double> y) {
  const std::optional<Line> line = least_squares_line(x, y);
  return line ? line->slope : kNan;
}

double loglog_slope(std::span<const double> x, std::span<const double> y) {
  std::vector<double> log_x;
  std::vector<double> log_y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    log_x.push_back(std::log(x[i]));
    log_y.push_back(std::log(y[i]));
  }
  return is_finite(log_x) && is_finite(log_y) ? slope(log_x, log_y) : kNan;
}

/// The coefficient of determination of the line of least squares: the product of both regressions'
/// slopes.
double r2(std::span<const double> x, std::span<const double> y) {
  return slope(x, y) * slope(y, x);
}

double spearman(std::span<const double> x, std::span<const double> y) {
  return rank_correlation(x, y).value_or(kNan);
}

/// The x of the row with the least `sign` times q.
Value argument_of_least(const Expression& call, Evaluation& evaluation, double sign) {
  const std::vector<std::size_t> rows = counted_rows(call, evaluation);
  std::vector<Number> numbers;
  std::vector<double> places;
  for (const std::size_t row : rows) {
    numbers.push_back(evaluate_formula(call.parts[1], row, evaluation));
    places.push_back(evaluate_formula(call.parts[2], row, evaluation).value);
  }
  Number number = reduce(numbers, [&](std::span<const double> values) {
    const auto least = std::min_element(values.begin(), values.end(),
                                        [=](double a, double b) { return sign * a < sign * b; });
    return places[static_cast<std::size_t>(least - values.begin())];
  });
  add_part(evaluation, call.text, number, rows.size());
  return single_value(std::move(number));
}

}  // namespace

Value slope_over_rows(const Expression& call, Evaluation& evaluation) {
  return fit_over_rows(call, evaluation, 2, slope);
}

Value loglog_slope_over_rows(const Expression& call, Evaluation& evaluation) {
  return fit_over_rows(call, evaluation, 2, loglog_slope);
}

Value r2_over_rows(const Expression& call, Evaluation& evaluation) {
  return fit_over_rows(call, evaluation, 3, r2);
}

Value spearman_over_rows(const Expression& call, Evaluation& evaluation) {
  return fit_over_rows(call, evaluation, 3, spearman);
}

Value argmin_over_rows(const Expression& call, Evaluation& evaluation) {
  return argument_of_least(call, evaluation, 1.0);
}

Value argmax_over_rows(const Expression& call, Evaluation& evaluation) {
  return argument_of_least(call, evaluation, -1.0);
}

Value smallest_that_meets(const Expression& call, Evaluation& evaluation) {
  const Expression& condition = call.parts.back();
  const std::vector<std::size_t> rows = counted_rows(call, evaluation);
  std::vector<Number> numbers;
  std::map<double, std::vector<std::size_t>> of_x;  // places in `numbers`
  for (const std::size_t row : rows) {
    of_x[evaluate_formula(call.parts[1], row, evaluation).value].push_back(numbers.size());
    numbers.push_back(evaluate_formula(condition.parts.front(), row, evaluation));
  }
  // A draw in which none does needs more than the largest x.
  Number number = combine(numbers, [&](std::span<const double> values) {
    for (const auto& [x, places] : of_x) {
      const bool is_met = std::all_of(places.begin(), places.end(), [&](std::size_t place) {
        return holds(values[place], condition.relation, condition.number);
      });
      if (is_met) return x;
    }
    return std::numeric_limits<double>::infinity();
  });
  if (std::isinf(number.value)) {
    throw base::InputError(fmt::format("{}: no {} meets {}, up to {}", call.text,
                                       call.parts[1].text, condition.text, of_x.rbegin()->first));
  }
  add_part(evaluation, call.text, number, rows.size());
  return single_value(std::move(number));
}

Value least_at_error(const Expression& call, Evaluation& evaluation) {
  const std::vector<std::size_t> rows = counted_rows(call, evaluation);
  // The costs of all rows, then their scores, then the bound.
  std::vector<Number> numbers;
  for (const std::size_t part : {std::size_t{1}, std::size_t{2}}) {
    for (const std::size_t row : rows) {
      numbers.push_back(evaluate_formula(call.parts[part], row, evaluation));
    }
  }
  numbers.push_back(evaluate_number(call.parts[3], evaluation));
  // A draw in which no row is good enough costs more than any.
  Number number = combine(numbers, [&](std::span<const double> values) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (values[rows.size() + i] <= values.back()) least = std::min(least, values[i]);
    }
    return least;
  });
  if (std::isinf(number.value)) {
    throw base::InputError(fmt::format("{}: no row of {} has {} <= {:.4g}", call.text,
                                       call.parts[0].text, call.parts[2].text,
                                       numbers.back().value));
  }
  add_part(evaluation, call.text, number, rows.size());
  return single_value(std::move(number));
}

}  // namespace results::claims
