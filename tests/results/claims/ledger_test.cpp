// The rows of a paper: which claims belong to them, and what is known of each.
#include "results/claims/ledger.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/expect_input_error.h"
#include "tests/results/claims/claim_run.h"

namespace {

using results::claims::Claim;
using results::claims::ClaimResult;
using results::claims::Ledger;
using results::claims::LedgerRow;
using results::claims::RowState;
using results::claims::Verdict;
using tests::input_error_of;

Ledger read(const std::string& yaml) {
  return results::claims::read_ledger(base::parse_document(yaml, "s.yaml"));
}

Claim claim(const std::string& id) {
  Claim one = test_results::claim_of({"count(pt)"}, ">= 1");
  one.id = id;
  return one;
}

ClaimResult judged(const std::string& id, Verdict verdict) {
  ClaimResult result;
  result.claim = claim(id);
  result.verdict = verdict;
  return result;
}

const Ledger kTwoRows{"Someone 2001", "xy", 2, {}, {}};

TEST(Ledger, IsReadAndWrittenAsInASuite) {
  const Ledger ledger =
      read("{source: Someone 2001, claims: xy, rows: 12, unmeasured: {xy-03: no film}}");
  EXPECT_EQ(ledger.row_id(3), "xy-03");
  EXPECT_EQ(ledger.row_id(12), "xy-12");
  ASSERT_EQ(ledger.unmeasured.size(), 1U);
  EXPECT_EQ(ledger.unmeasured[0].second, "no film");
  const Ledger again = read(results::claims::to_json(ledger).dump());
  EXPECT_EQ(results::claims::to_json(again), results::claims::to_json(ledger));
}

TEST(Ledger, RefusesWhatItCannotHold) {
  EXPECT_EQ(input_error_of([] { read("{source: a, claims: xy, rows: 0}"); }),
            "s.yaml:1:31: rows is 0; accepted: 1 to 999");
  const std::string unknown =
      input_error_of([] { read("{source: a, claims: xy, rows: 2, unmeasured: {xy-3: b}}"); });
  EXPECT_TRUE(unknown.starts_with("s.yaml:1:47: unknown row \"xy-3\"")) << unknown;
}

TEST(Ledger, WantsAClaimOrAReasonForEveryRow) {
  const std::vector<Claim> both{claim("xy-01"), claim("xy-01-b"), claim("xy-02-best")};
  EXPECT_EQ(input_error_of([&] { check_ledger(kTwoRows, both); }), "no error");
  const std::vector<Claim> one{claim("xy-01")};
  EXPECT_NE(input_error_of([&] {
              check_ledger(kTwoRows, one);
            }).find("row xy-02 has no claim; accepted: claims, or a reason in unmeasured"),
            std::string::npos);
  Ledger excused = kTwoRows;
  excused.unmeasured = {{"xy-02", "no film"}};
  EXPECT_EQ(input_error_of([&] { check_ledger(excused, one); }), "no error");
  EXPECT_NE(input_error_of([&] {
              check_ledger(excused, both);
            }).find("row xy-02 is measured, and is not"),
            std::string::npos);
  // xy-010 is no part of row xy-01.
  const std::vector<Claim> stray{claim("xy-01"), claim("xy-02"), claim("xy-010")};
  EXPECT_NE(input_error_of([&] { check_ledger(kTwoRows, stray); })
                .find("claim \"xy-010\" belongs to no row of the paper; accepted: ids that begin "
                      "with xy-01 to xy-02"),
            std::string::npos);
}

TEST(Ledger, KnowsThreeReasonsNotToCompare) {
  std::vector<Claim> claims{claim("xy-01"), claim("xy-02")};
  claims[1].comparable = results::claims::Comparable::no;
  claims[1].comparable_reason = "too hard";
  EXPECT_NE(input_error_of([&] { check_ledger(kTwoRows, claims); })
                .find("claim \"xy-02\" is not comparable for \"too hard\"; accepted reasons: "
                      "hardware time, lost scene, video"),
            std::string::npos);
  claims[1].comparable_reason = "lost scene";
  EXPECT_EQ(input_error_of([&] { check_ledger(kTwoRows, claims); }), "no error");
}

/// The state of one row that has these claims.
RowState state_of(const std::vector<Verdict>& verdicts) {
  std::vector<ClaimResult> results;
  for (const Verdict verdict : verdicts) results.push_back(judged("xy-01-a", verdict));
  return ledger_rows(kTwoRows, results)[0].state;
}

TEST(Ledger, RowsSumUpTheirClaims) {
  using enum Verdict;
  EXPECT_EQ(state_of({}), RowState::unmeasured);
  EXPECT_EQ(state_of({reproduced, reproduced, printed}), RowState::reproduced);
  EXPECT_EQ(state_of({reproduced, not_reproduced}), RowState::in_part);
  EXPECT_EQ(state_of({not_reproduced, inconclusive}), RowState::not_reproduced);
  // One that is open is not passed over because others hold.
  EXPECT_EQ(state_of({reproduced, inconclusive}), RowState::inconclusive);
  EXPECT_EQ(state_of({reproduced, not_comparable}), RowState::reproduced);
  EXPECT_EQ(state_of({not_comparable, printed}), RowState::not_comparable);
  EXPECT_EQ(state_of({printed}), RowState::printed);
}

/// What holds for the corrected preset says nothing of what was published.
TEST(Ledger, KeepsTheCorrectedPresetApart) {
  const std::vector<ClaimResult> results{judged("xy-01", Verdict::not_reproduced),
                                         judged("xy-01-best", Verdict::reproduced),
                                         judged("xy-02", Verdict::reproduced)};
  const std::vector<LedgerRow> rows = ledger_rows(kTwoRows, results);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].state, RowState::not_reproduced);
  EXPECT_EQ(rows[0].corrected_state, RowState::reproduced);
  EXPECT_EQ(rows[1].state, RowState::reproduced);
  EXPECT_EQ(rows[1].corrected_state, RowState::unmeasured);
  EXPECT_TRUE(rows[1].corrected.empty());
}

}  // namespace
