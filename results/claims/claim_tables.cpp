#include "results/claims/claim_tables.h"

#include <fmt/format.h>

#include "results/claims/judgement.h"

namespace results::claims {
namespace {

TableCell words(std::string text) { return {std::move(text), std::nullopt, false, ""}; }

/// The value, or those of a list in its order.
std::string value_text(const ClaimResult& result) {
  if (result.value) return format_number(*result.value, result.interval);
  return result.parts.empty() ? "-" : fmt::format("{} values", result.parts.size());
}

}  // namespace

std::string format_verdict(Verdict verdict) {
  switch (verdict) {
    case Verdict::reproduced:
      return "+ reproduced";
    case Verdict::not_reproduced:
      return "x not reproduced";
    case Verdict::inconclusive:
      return "? inconclusive";
    case Verdict::not_comparable:
      return "- not comparable";
    case Verdict::printed:
      break;
  }
  return ". printed";
}

Table claim_table(std::span<const ClaimResult> results) {
  Table table;
  for (const char* title :
       {"verdict", "claim", "item", "value", "expected", "paper prints", "reason"}) {
    table.columns.push_back({title, "", Direction::none, false});
  }
  for (const ClaimResult& result : results) {
    table.rows.push_back({words(format_verdict(result.verdict)), words(result.claim.id),
                          words(result.claim.item), words(value_text(result)),
                          words(result.claim.expect), words(result.claim.printed),
                          words(result.reason)});
  }
  table.notes.push_back(results.empty() ? "no claims" : format_counts(results));
  table.notes.emplace_back(
      "[ ] is the 95 % interval: repetitions of times and seeds of scores drawn again");
  return table;
}

}  // namespace results::claims
