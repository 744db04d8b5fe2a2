#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/claims/claim.h"
#include "results/claims/evaluation.h"
#include "results/run_values.h"

namespace results::claims {

/// What a run says of a claim.
enum class Verdict {
  reproduced,
  not_reproduced,
  inconclusive,    ///< the interval straddles the bound, or there is no value; the reason says why
  not_comparable,  ///< the claim says that, and why
  printed          ///< nothing is expected
};
/// "reproduced", "not reproduced", ...
const char* to_words(Verdict verdict);

struct ClaimResult {
  Claim claim;
  Verdict verdict = Verdict::inconclusive;
  std::string reason;                ///< one sentence; "" if there is nothing to add
  std::optional<double> value;       ///< of a measure that is one number
  std::optional<Interval> interval;  ///< 95 %; absent if nothing behind it was measured twice
  std::vector<ClaimPart> parts;      ///< the numbers behind it
};

/// A claim that cannot be evaluated is inconclusive with the reason; no error is thrown.
ClaimResult evaluate(const Claim& claim, const RunValues& values);
/// All of them; what they share is computed once.
std::vector<ClaimResult> evaluate(std::span<const Claim> claims, const RunValues& values);

/// What can be known before a run: methods, keys and metrics exist, and `value` is of one row.
/// @param planned  a run of planned cells, without records
/// @throws base::InputError with the place
void check_claims(std::span<const Claim> claims, const RunValues& planned);

/// {"schema":1,"counts":{...},"all_reproduced":..,"claims":[...]}; null for what is not a finite
/// number.
nlohmann::ordered_json to_json(std::span<const ClaimResult> results);

/// Verdicts that occur, in the order of `Verdict`.
std::vector<std::pair<Verdict, std::size_t>> count_verdicts(std::span<const ClaimResult> results);
/// "reproduced 12, not reproduced 1".
std::string format_counts(std::span<const ClaimResult> results);
/// Whether at least one is reproduced, and none is not reproduced or inconclusive.
bool all_reproduced(std::span<const ClaimResult> results);

}  // namespace results::claims
