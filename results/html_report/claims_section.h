#pragma once

#include <span>
#include <string>

#include "results/claims/claim_result.h"

namespace results::html_report {

/// What the papers say and what the run says of it: counts of verdicts, then a row per claim with
/// the numbers behind it folded in. Verdicts are told apart by words and signs, too. "" for none.
std::string claims_section(std::span<const claims::ClaimResult> results);

/// What a verdict looks like, in words with a sign; @param count  after the words, " 3"
std::string verdict_chip(claims::Verdict verdict, const std::string& count);
/// A row of six cells: verdict, claim, what it says, value, expected, paper prints.
std::string claim_row(const claims::ClaimResult& result);
/// The titles of those.
std::string claim_titles();

}  // namespace results::html_report
