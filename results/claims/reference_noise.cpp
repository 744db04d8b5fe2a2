#include "results/claims/reference_noise.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/units.h"
#include "results/claims/function_table.h"

namespace results::claims {
namespace {

/// The scores that an argument names.
void collect_scores(const Expression& argument, const RunValues& values,
                    std::vector<Quantity>& scores) {
  if (argument.kind == Expression::Kind::quantity) {
    Quantity quantity = values.find_quantity(argument.name, {});
    if (quantity.kind == Quantity::Kind::score) scores.push_back(std::move(quantity));
  }
  for (const Expression& part : argument.parts) collect_scores(part, values, scores);
}

/// Of all arguments that are numbers of a row; an axis may be a key, which is no quantity.
std::vector<Quantity> scores_of(const Expression& call, const RunValues& values) {
  std::vector<Quantity> scores;
  const std::vector<ArgumentKind>& kinds = call.function->arguments;
  for (std::size_t i = 0; i < call.parts.size(); ++i) {
    const ArgumentKind kind = kinds[std::min(i, kinds.size() - 1)];
    const bool is_of_row = kind == ArgumentKind::quantity || kind == ArgumentKind::formula ||
                           kind == ArgumentKind::condition;
    if (is_of_row) collect_scores(call.parts[i], values, scores);
  }
  return scores;
}

/// What is below the noise floor: "pt on box at 64spp (relmse 0.0012, floor 0.001)"; "" if nothing.
std::string below_noise(std::size_t row, const std::vector<Quantity>& scores,
                        const Evaluation& evaluation) {
  const SummaryRow& summary = evaluation.numbers.values().summary().rows[row];
  for (const Quantity& score : scores) {
    const ScoreSummary* found = summary.find_score(score.name, score.against);
    if (found == nullptr || found->noise_share.value_or(0.0) < kMostNoiseShare) continue;
    return fmt::format("{} ({} {}, floor {})", evaluation.numbers.row_name(row), score.text,
                       base::format_significant(found->score->value, 3),
                       base::format_significant(*found->noise_floor, 3));
  }
  return "";
}

}  // namespace

std::vector<std::size_t> counted_rows(const Expression& call, Evaluation& evaluation) {
  return counted_rows(call, selected_rows(call.parts.front(), evaluation), evaluation);
}

std::vector<std::size_t> counted_rows(const Expression& call, std::vector<std::size_t> rows,
                                      Evaluation& evaluation) {
  if (evaluation.below_noise == BelowNoise::counts) return rows;
  const std::vector<Quantity> scores = scores_of(call, evaluation.numbers.values());
  std::vector<std::string> left_out;
  std::erase_if(rows, [&](std::size_t row) {
    const std::string what = below_noise(row, scores, evaluation);
    if (!what.empty()) left_out.push_back(what);
    return !what.empty();
  });
  if (left_out.empty()) return rows;
  if (rows.empty() || evaluation.below_noise == BelowNoise::inconclusive) {
    throw base::InputError(
        fmt::format("{}: at the noise of the reference: {}", call.text, fmt::join(left_out, ", ")));
  }
  evaluation.left_out.insert(left_out.begin(), left_out.end());
  return rows;
}

}  // namespace results::claims
