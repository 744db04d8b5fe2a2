#pragma once

#include <span>
#include <string>

#include "results/claims/claim_result.h"

namespace results::html_report {

/// What the papers say and what the run says of it: counts of verdicts, then a row per claim with
/// the numbers behind it folded in. Verdicts are told apart by words and signs, too. "" for none.
std::string claims_section(std::span<const claims::ClaimResult> results);

}  // namespace results::html_report
