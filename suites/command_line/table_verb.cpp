#include <optional>
#include <ostream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/rank_agreement.h"
#include "results/result_store.h"
#include "results/run_summary.h"
#include "results/table_formats.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/verbs.h"
#include "suites/name_filter.h"

namespace suites::command_line {

namespace {

std::optional<results::Quantity> find_score(const results::RunValues& values,
                                            const std::string& text) {
  try {
    results::Quantity quantity = values.find_quantity(text, {});
    if (quantity.kind == results::Quantity::Kind::score) return quantity;
  } catch (const base::InputError&) {
    // Told below, with what would be accepted.
  }
  return std::nullopt;
}

/// Scores may have commas of their own: "relmse,trim=0.001,flip" is parted where both sides are.
results::Table rankings_table(const results::Run& run, const std::string& scores) {
  const results::RunValues values(run);
  for (std::size_t comma = scores.find(','); comma != std::string::npos;
       comma = scores.find(',', comma + 1)) {
    const auto first = find_score(values, scores.substr(0, comma));
    const auto second = find_score(values, scores.substr(comma + 1));
    if (first && second) return results::rank_agreement_table(values, *first, *second);
  }
  throw base::InputError(
      base::Place{"--rankings"},
      fmt::format("\"{}\" is not accepted; accepted: two scores of the run, A,B, of {}", scores,
                  fmt::join(values.summary().metrics, ", ")));
}

results::Table numbers_table(const results::Run& run, const std::string& filter) {
  results::RunSummary summary = results::summarize(run);
  const NameFilter names(filter);
  std::erase_if(summary.rows, [&](const results::SummaryRow& row) {
    return !names.matches(row.scene) && !names.matches(row.method) && !names.matches(row.budget);
  });
  results::Table table = results::summary_table(summary);
  results::mark_best(table);
  return table;
}

}  // namespace

int run_table(const TableArguments& arguments, Console& console) {
  const std::filesystem::path root = results::results_root(arguments.results);
  const results::Run run = results::load_run(results::find_run(root, arguments.run));
  const bool is_ranking = !arguments.rankings.empty();
  if (is_ranking && !arguments.filter.empty()) {
    throw base::InputError("--filter does not go with --rankings, which is of all rows");
  }
  const results::Table table =
      is_ranking ? rankings_table(run, arguments.rankings) : numbers_table(run, arguments.filter);
  console.out << results::to_format(table, arguments.format);
  return table.rows.empty() && !is_ranking ? kNothingMeasured : kAsExpected;
}

}  // namespace suites::command_line
