#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/document.h"
#include "results/claims/claim_result.h"

/// Everything that a paper says, as numbered rows: tables, figures and sentences that claim
/// something. A claim of a suite belongs to the row that its id begins with: `rb-01` and
/// `rb-01-rmse` to row `rb-01`.
namespace results::claims {

/// The entry `paper:` of a suite.
struct Ledger {
  std::string source;  ///< authors, year, title, where
  std::string prefix;  ///< of the rows' ids
  std::size_t rows = 0;
  /// Rows that no claim is about, and why.
  std::vector<std::pair<std::string, std::string>> unmeasured;
  base::Place place;

  /// "rb-01"; from 1.
  std::string row_id(std::size_t number) const;
};

/// `{source: TEXT, claims: PREFIX, rows: COUNT, unmeasured: {ID: REASON}}`.
/// @throws base::InputError with file:line:column
Ledger read_ledger(const base::Node& node);
/// As in a suite.
nlohmann::ordered_json to_json(const Ledger& ledger);

/// Every row has claims, or a reason why there are none; every claim belongs to a row; and what is
/// not comparable has one of kIncomparable as its reason.
/// @throws base::InputError with the place
void check_ledger(const Ledger& ledger, std::span<const Claim> claims);
inline constexpr std::array kIncomparable{"hardware time", "lost scene", "video"};

/// What is known of a row.
enum class RowState {
  reproduced,      ///< every claim that is judged
  in_part,         ///< some are, some are not
  not_reproduced,  ///< none is
  inconclusive,    ///< none is refuted, and one has no verdict
  not_comparable,
  printed,    ///< numbers without a verdict
  unmeasured  ///< no claim, or no run
};
inline constexpr std::array kRowStates{
    RowState::reproduced,     RowState::in_part, RowState::not_reproduced, RowState::inconclusive,
    RowState::not_comparable, RowState::printed, RowState::unmeasured};
/// "reproduced", "in part", ...
const char* to_words(RowState state);

/// A row with its claims, those of the technique as published and those of its corrected preset
/// (ids with `best`) apart.
struct LedgerRow {
  std::string id;
  std::vector<const ClaimResult*> published;
  std::vector<const ClaimResult*> corrected;
  std::string why_unmeasured;
  RowState state = RowState::unmeasured;            ///< of `published`
  RowState corrected_state = RowState::unmeasured;  ///< of `corrected`
};

/// @param results  must outlive the rows
std::vector<LedgerRow> ledger_rows(const Ledger& ledger, std::span<const ClaimResult> results);

}  // namespace results::claims
