#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/claims/row_functions.h"
#include "results/convergence.h"

namespace results::claims {
namespace {

/// One curve per seed of the call's row.
struct CurvesOfRow {
  std::size_t row = 0;
  Quantity score;
  std::vector<ConvergenceCurve> curves;
};

CurvesOfRow curves_of(const Expression& call, Evaluation& evaluation) {
  const RunValues& values = evaluation.numbers.values();
  CurvesOfRow found;
  found.row = single_row(call, evaluation);
  found.score = values.find_quantity(call.parts[1].name, {});
  if (found.score.kind != Quantity::Kind::score) {
    throw base::InputError(fmt::format("{}: {} is no score", call.text, found.score.text));
  }
  found.curves = convergence_curves(values, found.row, found.score);
  if (!found.curves.empty()) return found;
  throw base::InputError(
      fmt::format("{} has no scored checkpoints; they need a progressive renderer "
                  "and `measure: {{convergence: true}}`",
                  evaluation.numbers.row_name(found.row)));
}

/// The curves that do not get there would make the others look too good.
void require_all(const Expression& call, const CurvesOfRow& of_row, std::size_t count,
                 const Evaluation& evaluation) {
  if (count == of_row.curves.size()) return;
  double first_s = 0.0;
  double last_s = 0.0;
  double best = of_row.curves.front().points.back().error;
  for (const ConvergenceCurve& curve : of_row.curves) {
    first_s = std::max(first_s, curve.points.front().time_s);
    last_s = std::max(last_s, curve.points.back().time_s);
    best = curve.points.back().error;
  }
  throw base::InputError(
      fmt::format("{} lies on the curves of {} of {} seeds of {}, which go from {:.4g} s to {:.4g} "
                  "s and end at "
                  "{} {:.4g}",
                  call.text, count, of_row.curves.size(), evaluation.numbers.row_name(of_row.row),
                  first_s, last_s, of_row.score.text, best));
}

}  // namespace

Value score_at_time_of_row(const Expression& call, Evaluation& evaluation) {
  const CurvesOfRow of_row = curves_of(call, evaluation);
  const std::vector<double> scores = scores_at_time(of_row.curves, call.parts[2].number);
  require_all(call, of_row, scores.size(), evaluation);
  Number number = resampled_mean(scores, of_row.row, Noise::seeds);
  add_part(evaluation, call.text, number, 1);
  return single_value(std::move(number));
}

Value time_to_score_of_row(const Expression& call, Evaluation& evaluation) {
  const CurvesOfRow of_row = curves_of(call, evaluation);
  const metrics::MetricDescription* info = metric_info_of(of_row.score.name);
  const bool is_falling = info == nullptr || info->better == metrics::Better::lower;
  std::vector<double> logarithms;
  for (const double time_s : times_to_score(of_row.curves, call.parts[2].number, is_falling)) {
    logarithms.push_back(std::log(time_s));
  }
  require_all(call, of_row, logarithms.size(), evaluation);
  const Number logarithm = resampled_mean(logarithms, of_row.row, Noise::seeds);
  const Number* const inputs[] = {&logarithm};
  Number number = combine(inputs, [](std::span<const double> in) { return std::exp(in[0]); });
  add_part(evaluation, call.text, number, 1);
  return single_value(std::move(number));
}

}  // namespace results::claims
