#include "results/claims/ledger.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace results::claims {

using nlohmann::ordered_json;

namespace {

constexpr std::int64_t kMostRows = 999;

/// Whether a claim's id is a row's, or begins with it and a dash.
bool belongs(const std::string& claim, const std::string& row) {
  return claim == row || claim.starts_with(row + "-");
}

bool is_corrected(const std::string& claim) { return claim.find("best") != std::string::npos; }

std::vector<std::string> ids_of(const Ledger& ledger) {
  std::vector<std::string> ids;
  for (std::size_t i = 1; i <= ledger.rows; ++i) ids.push_back(ledger.row_id(i));
  return ids;
}

RowState state_of(const std::vector<const ClaimResult*>& claims) {
  const auto count = [&](Verdict verdict) {
    return std::ranges::count(claims, verdict, &ClaimResult::verdict);
  };
  const auto reproduced = count(Verdict::reproduced);
  const auto refuted = count(Verdict::not_reproduced);
  if (reproduced > 0 && refuted > 0) return RowState::in_part;
  if (refuted > 0) return RowState::not_reproduced;
  if (count(Verdict::inconclusive) > 0) return RowState::inconclusive;
  if (reproduced > 0) return RowState::reproduced;
  if (count(Verdict::not_comparable) > 0) return RowState::not_comparable;
  return claims.empty() ? RowState::unmeasured : RowState::printed;
}

}  // namespace

std::string Ledger::row_id(std::size_t number) const {
  return fmt::format("{}-{:02}", prefix, number);
}

Ledger read_ledger(const base::Node& node) {
  base::MapReader reader(node, "paper");
  Ledger ledger;
  ledger.place = node.place();
  ledger.source = reader.require("source").text("source");
  ledger.prefix = reader.require("claims").text("claims");
  const base::Node& rows = reader.require("rows");
  const std::int64_t count = rows.integer("rows");
  if (count < 1 || count > kMostRows) {
    throw base::InputError(rows.place(),
                           fmt::format("rows is {}; accepted: 1 to {}", count, kMostRows));
  }
  ledger.rows = static_cast<std::size_t>(count);
  if (const base::Node* list = reader.find("unmeasured")) {
    const std::vector<std::string> ids = ids_of(ledger);
    for (const auto& [id, reason] : list->entries()) {
      if (std::ranges::find(ids, id) == ids.end()) {
        throw base::InputError(list->key_place(id), base::unknown_name("row", id, ids));
      }
      ledger.unmeasured.emplace_back(id, reason.text("unmeasured"));
    }
  }
  reader.finish();
  return ledger;
}

ordered_json to_json(const Ledger& ledger) {
  ordered_json json{{"source", ledger.source}, {"claims", ledger.prefix}, {"rows", ledger.rows}};
  if (!ledger.unmeasured.empty()) {
    ordered_json reasons = ordered_json::object();
    for (const auto& [id, reason] : ledger.unmeasured) reasons[id] = reason;
    json["unmeasured"] = std::move(reasons);
  }
  return json;
}

void check_ledger(const Ledger& ledger, std::span<const Claim> claims) {
  const std::vector<std::string> ids = ids_of(ledger);
  for (const Claim& claim : claims) {
    if (std::ranges::none_of(ids, [&](const std::string& id) { return belongs(claim.id, id); })) {
      throw base::InputError(claim.place,
                             fmt::format("claim \"{}\" belongs to no row of the paper; "
                                         "accepted: ids that begin with {} to {}",
                                         claim.id, ids.front(), ids.back()));
    }
    if (claim.comparable == Comparable::no &&
        std::ranges::find(kIncomparable, claim.comparable_reason) == kIncomparable.end()) {
      throw base::InputError(
          claim.place,
          fmt::format("claim \"{}\" is not comparable for \"{}\"; accepted reasons: {}", claim.id,
                      claim.comparable_reason, fmt::join(kIncomparable, ", ")));
    }
  }
  for (const std::string& id : ids) {
    const bool has_claim =
        std::ranges::any_of(claims, [&](const Claim& claim) { return belongs(claim.id, id); });
    const bool has_reason = std::ranges::any_of(
        ledger.unmeasured, [&](const auto& entry) { return entry.first == id; });
    if (has_claim != has_reason) continue;
    throw base::InputError(ledger.place,
                           has_claim ? fmt::format("row {} is measured, and is not; accepted: "
                                                   "claims, or a reason in unmeasured",
                                                   id)
                                     : fmt::format("row {} has no claim; accepted: claims, or a "
                                                   "reason in unmeasured",
                                                   id));
  }
}

const char* to_words(RowState state) {
  switch (state) {
    case RowState::reproduced:
      return "reproduced";
    case RowState::in_part:
      return "in part";
    case RowState::not_reproduced:
      return "not reproduced";
    case RowState::inconclusive:
      return "inconclusive";
    case RowState::not_comparable:
      return "not comparable";
    case RowState::printed:
      return "printed";
    case RowState::unmeasured:
      break;
  }
  return "not measured";
}

std::vector<LedgerRow> ledger_rows(const Ledger& ledger, std::span<const ClaimResult> results) {
  std::vector<LedgerRow> rows;
  for (const std::string& id : ids_of(ledger)) {
    LedgerRow row;
    row.id = id;
    for (const ClaimResult& result : results) {
      if (!belongs(result.claim.id, id)) continue;
      (is_corrected(result.claim.id) ? row.corrected : row.published).push_back(&result);
    }
    for (const auto& [unmeasured, reason] : ledger.unmeasured) {
      if (unmeasured == id) row.why_unmeasured = reason;
    }
    row.state = state_of(row.published);
    row.corrected_state = state_of(row.corrected);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace results::claims
