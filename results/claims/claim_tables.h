#pragma once

#include <span>

#include "results/claims/claim_result.h"
#include "results/tables.h"

namespace results::claims {

/// "+ reproduced", "x not reproduced", "? inconclusive", "- not comparable", "  printed": verdicts
/// that are told apart without colour.
std::string format_verdict(Verdict verdict);

/// A row per claim: verdict, id, item, what is expected, value with its interval, what the paper
/// prints, reason. Its notes have the counts and say what the interval is.
Table claim_table(std::span<const ClaimResult> results);

}  // namespace results::claims
