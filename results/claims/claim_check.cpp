#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/claims/claim_result.h"
#include "results/claims/expression.h"
#include "results/claims/function_table.h"

namespace results::claims {
namespace {

/// Compares what expressions name with what a planned run will have.
class ClaimChecker {
 public:
  explicit ClaimChecker(const RunValues& planned)
      : planned_(planned), profile_(planned.run().info->value("profile", "")) {}

  void check(const Claim& claim) const {
    const bool counts =
        claim.profiles.empty() ||
        std::find(claim.profiles.begin(), claim.profiles.end(), profile_) != claim.profiles.end();
    for (std::size_t i = 0; i < claim.measures.size(); ++i) {
      const base::Place& place = claim.measure_places[i];
      check(parse_expression(claim.measures[i], place), place, counts);
    }
  }

 private:
  void check(const Expression& expression, const base::Place& place, bool counts) const {
    if (expression.kind == Expression::Kind::rows) {
      select_rows(planned_.rows(), expression.selector, place);
    }
    if (expression.kind == Expression::Kind::quantity) {
      planned_.check_quantity(expression.name, place_within(place, expression.position));
    }
    if (expression.kind != Expression::Kind::call) {
      for (const Expression& part : expression.parts) check(part, place, counts);
      return;
    }
    for (std::size_t i = 0; i < expression.parts.size(); ++i) {
      const std::vector<ArgumentKind>& kinds = expression.function->arguments;
      const ArgumentKind kind = kinds[std::min(i, kinds.size() - 1)];
      if (kind == ArgumentKind::stages) continue;  // known when they have run
      if (kind == ArgumentKind::axis && is_key(expression.parts[i])) continue;
      check(expression.parts[i], place, counts);
    }
    if (counts) check_single(expression, place);
  }

  bool is_key(const Expression& axis) const {
    const auto& rows = planned_.rows();
    return axis.kind == Expression::Kind::quantity &&
           std::any_of(rows.begin(), rows.end(),
                       [&](const RowFacts& row) { return row.find(axis.name) != nullptr; });
  }

  /// Functions of one row.
  void check_single(const Expression& call, const base::Place& place) const {
    static constexpr std::array<std::string_view, 4> kOfOneRow{"value", "last", "error_at",
                                                               "time_to"};
    if (std::find(kOfOneRow.begin(), kOfOneRow.end(), call.function->name) == kOfOneRow.end())
      return;
    const Expression& rows = call.parts.front();
    const std::size_t count = select_rows(planned_.rows(), rows.selector, place).size();
    if (count <= 1) return;
    throw base::InputError(
        place_within(place, rows.position),
        fmt::format("{} is of exactly one row; {} are {}: narrow it, e.g. {}[scene=...], or take "
                    "median(...)",
                    call.function->name, count, rows.text, rows.selector.method));
  }

  const RunValues& planned_;
  std::string profile_;
};

}  // namespace

void check_claims(std::span<const Claim> claims, const RunValues& planned) {
  const ClaimChecker checker(planned);
  for (const Claim& claim : claims) checker.check(claim);
}

}  // namespace results::claims
