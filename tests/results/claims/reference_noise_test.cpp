// Claims on scores that are mostly noise of their references.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/expect_input_error.h"
#include "tests/results/claims/claim_run.h"

namespace {

using results::claims::BelowNoise;
using results::claims::ClaimResult;
using results::claims::Verdict;
using test_results::claim_of;
using test_results::ClaimRun;

ClaimRun::Method pt(int depth) { return {"pt", "depth", depth}; }

/// Errors that fall as 0.64 / depth^2 until the noise of the reference, 0.02, is all there is.
ClaimRun run_with_floor() {
  ClaimRun run;
  run.scores(pt(1), "relmse", {0.64, 0.64})
      .scores(pt(2), "relmse", {0.16, 0.16})
      .scores(pt(4), "relmse", {0.041, 0.041})
      .scores(pt(8), "relmse", {0.021, 0.019})
      .scores(pt(16), "relmse", {0.02, 0.022})
      .noise_floor(0.02);
  return run;
}

ClaimResult judge(const ClaimRun& run, const std::string& measure, const std::string& expect,
                  BelowNoise below_noise) {
  results::claims::Claim claim = claim_of({measure}, expect);
  claim.below_noise = below_noise;
  return results::claims::evaluate(claim, results::RunValues(run.run()));
}

TEST(ReferenceNoise, PointsAtItAreLeftOutOfAFit) {
  const ClaimRun run = run_with_floor();
  const std::string slope = "loglog_slope(pt, relmse, depth)";
  const ClaimResult all = judge(run, slope, "= -2 within 0.05", BelowNoise::counts);
  EXPECT_EQ(all.verdict, Verdict::not_reproduced);
  const ClaimResult above = judge(run, slope, "= -2 within 0.05", BelowNoise::skip);
  EXPECT_EQ(above.verdict, Verdict::reproduced) << above.reason;
  EXPECT_EQ(above.parts.front().rows, 3U);
  EXPECT_NE(above.reason.find("left out at the noise of the reference: pt[depth=16] on box at "
                              "64spp (relmse 0.0210, floor 0.0200), pt[depth=8] on box"),
            std::string::npos)
      << above.reason;
  const ClaimResult none = judge(run, slope, "= -2 within 0.05", BelowNoise::inconclusive);
  EXPECT_EQ(none.verdict, Verdict::inconclusive);
  EXPECT_FALSE(none.value.has_value());
  EXPECT_EQ(none.reason.find(slope + ": at the noise of the reference: pt[depth=8] on box"), 0U)
      << none.reason;
}

TEST(ReferenceNoise, HalfOfTheErrorIsTheLimit) {
  ClaimRun run = run_with_floor();
  const auto rows = [&](double floor) {
    run.noise_floor(floor);
    return judge(run, "mean(pt, relmse)", "printed", BelowNoise::skip).parts.front().rows;
  };
  EXPECT_EQ(rows(0.0206), 2U);  // 0.041 is less than twice that
  EXPECT_EQ(rows(0.0204), 3U);
  EXPECT_EQ(rows(0.001), 5U);
}

TEST(ReferenceNoise, ARowThatIsAskedForByItselfHasNoValueAtIt) {
  const ClaimRun run = run_with_floor();
  const std::string best = "value(pt[depth=8], relmse)";
  EXPECT_EQ(judge(run, best, "<= 0.03", BelowNoise::counts).verdict, Verdict::reproduced);
  for (const BelowNoise policy : {BelowNoise::skip, BelowNoise::inconclusive}) {
    EXPECT_EQ(judge(run, best, "<= 0.03", policy).verdict, Verdict::inconclusive);
    EXPECT_EQ(judge(run, "value(pt[depth=1], relmse)", "<= 1", policy).verdict,
              Verdict::reproduced);
  }
  // Times know of no reference.
  EXPECT_EQ(judge(run, "value(pt[depth=8], total_s)", "<= 1", BelowNoise::inconclusive).verdict,
            Verdict::reproduced);
}

TEST(ReferenceNoise, SeriesAndConditionsLookAtItToo) {
  const ClaimRun run = run_with_floor();
  const ClaimResult series =
      judge(run, "series(pt, relmse, depth)", "decreasing", BelowNoise::skip);
  EXPECT_EQ(series.verdict, Verdict::reproduced) << series.reason;
  EXPECT_EQ(series.elements.size(), 3U);
  EXPECT_EQ(judge(run, "smallest(pt, depth, relmse < 0.03)", ">= 1", BelowNoise::skip).verdict,
            Verdict::inconclusive);
  EXPECT_EQ(judge(run, "smallest(pt, depth, relmse < 0.03)", "= 8", BelowNoise::counts).verdict,
            Verdict::reproduced);
}

TEST(ReferenceNoise, IsReadAndWrittenWithTheClaim) {
  const auto read = [](const std::string& value) {
    return results::claims::read_claims(base::parse_document(
        "- {id: a, item: b, says: c, measure: \"count(pt)\", expect: \"= 1\", below_noise: " +
            value + "}\n",
        "claims.yaml"));
  };
  const auto claims = read("skip");
  EXPECT_EQ(claims.front().below_noise, BelowNoise::skip);
  const auto again = results::claims::claims_from_json(results::claims::to_json(claims));
  EXPECT_EQ(again.front().below_noise, BelowNoise::skip);
  EXPECT_FALSE(results::claims::to_json(read("counts").front()).contains("below_noise"));
  EXPECT_NE(tests::input_error_of([&] {
              read("ignore");
            }).find("unknown below_noise \"ignore\"; known: counts, skip, inconclusive"),
            std::string::npos);
}

}  // namespace
