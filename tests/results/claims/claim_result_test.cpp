// Verdicts: what is said of a run, and that a claim that is wrong is not reproduced.
#include "results/claims/claim_result.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/claims/claim_tables.h"
#include "results/html_report/claims_section.h"
#include "results/html_report/html_report.h"
#include "tests/expect_input_error.h"
#include "tests/results/claims/claim_run.h"

namespace {

using results::claims::ClaimResult;
using results::claims::Verdict;
using test_results::claim_of;
using test_results::ClaimRun;

ClaimRun::Method val(int vals, const std::string& scene = "box") {
  return {"val", "vals", vals, scene};
}

/// Errors that fall with vals, 4 seeds each; times that rise.
ClaimRun falling_run() {
  ClaimRun run;
  run.scores(val(2), "relmse", {0.40, 0.41, 0.39, 0.40})
      .scores(val(5), "relmse", {0.20, 0.21, 0.19, 0.20})
      .scores(val(10), "relmse", {0.10, 0.11, 0.09, 0.10});
  return run;
}

TEST(ClaimVerdicts, OfABoundRestOnTheWholeInterval) {
  ClaimRun run;
  run.times({"a"}, {1.0, 1.1, 0.9, 1.0, 1.05, 0.95});
  EXPECT_EQ(run.judge({"value(a, total_s)"}, "<= 1.2").verdict, Verdict::reproduced);
  EXPECT_EQ(run.judge({"value(a, total_s)"}, ">= 1.2").verdict, Verdict::not_reproduced);
  const ClaimResult straddling = run.judge({"value(a, total_s)"}, "<= 1.0");
  EXPECT_EQ(straddling.verdict, Verdict::inconclusive);
  EXPECT_EQ(straddling.value, 1.0);
  EXPECT_LT(straddling.interval->low, 1.0);
  EXPECT_GT(straddling.interval->high, 1.0);
  EXPECT_EQ(straddling.reason.find("1.000 ["), 0U) << straddling.reason;
  EXPECT_NE(straddling.reason.find("may be or may not be <= 1.0"), std::string::npos);
}

TEST(ClaimVerdicts, OfASingleSampleRestOnTheValueAndSaySo) {
  ClaimRun run;
  run.times({"a"}, {1.0}).times({"b"}, {2.0, 2.1, 1.9});
  const ClaimResult single = run.judge({"value(a, total_s)"}, "<= 1.2");
  EXPECT_EQ(single.verdict, Verdict::reproduced);
  EXPECT_FALSE(single.interval);
  EXPECT_EQ(single.reason, "rests on the value: no row behind it has two repetitions or seeds");
  EXPECT_EQ(run.judge({"value(a, total_s)"}, ">= 1.2").verdict, Verdict::not_reproduced);
  const ClaimResult mixed = run.judge({"value(b, total_s) / value(a, total_s)"}, ">= 1.5");
  EXPECT_EQ(mixed.verdict, Verdict::reproduced);
  EXPECT_EQ(mixed.reason, "the interval leaves out 1 row of a single sample");
}

TEST(ClaimVerdicts, OfOrdersAndTrends) {
  const ClaimRun run = falling_run();
  const std::vector<std::string> series{"series(val, relmse, vals)"};
  EXPECT_EQ(run.judge(series, "falls").verdict, Verdict::reproduced);
  EXPECT_EQ(run.judge(series, "rises").verdict, Verdict::not_reproduced);
  EXPECT_EQ(run.judge(series, "decreasing").verdict, Verdict::reproduced);
  const ClaimResult wrong = run.judge(series, "increasing");
  EXPECT_EQ(wrong.verdict, Verdict::not_reproduced);
  EXPECT_EQ(wrong.reason.find("5 less 2: -0.2000 ["), 0U) << wrong.reason;
  EXPECT_EQ(run.judge(series, "largest").verdict, Verdict::reproduced);
  EXPECT_EQ(run.judge(series, "smallest").verdict, Verdict::not_reproduced);
  const std::vector<std::string> list{"value(val[vals=10], relmse)", "value(val[vals=2], relmse)"};
  EXPECT_EQ(run.judge(list, "increasing").verdict, Verdict::reproduced);
  EXPECT_EQ(run.judge(list, "largest").verdict, Verdict::not_reproduced);
  EXPECT_EQ(run.judge(list, "falls").reason, "a trend needs at least 3 values; there are 2");
  // A bound of a list is one of every element.
  EXPECT_EQ(run.judge(series, "<= 0.5").verdict, Verdict::reproduced);
  const ClaimResult bound = run.judge(series, "<= 0.3");
  EXPECT_EQ(bound.verdict, Verdict::not_reproduced);
  EXPECT_EQ(bound.reason.find("2: 0.4000 ["), 0U) << bound.reason;
}

TEST(ClaimVerdicts, OfEqualNumbersAreNoOrder) {
  ClaimRun run;
  run.scores({"a"}, "relmse", {0.1, 0.1}).scores({"b"}, "relmse", {0.1, 0.1});
  const std::vector<std::string> list{"value(a, relmse)", "value(b, relmse)"};
  EXPECT_EQ(run.judge(list, "increasing").verdict, Verdict::not_reproduced);
  EXPECT_EQ(run.judge(list, "decreasing").verdict, Verdict::not_reproduced);
}

TEST(ClaimVerdicts, OfAShareCompareTheStagesBesideIt) {
  // Shares of timed_cell: transport 0.5, build 0.2 (build/bvh 0.15), gather 0.15, lights 0.05.
  ClaimRun run;
  run.times({"a"}, {1.0, 1.1, 0.9});
  EXPECT_EQ(run.judge({"share(a, transport)"}, "largest").verdict, Verdict::reproduced);
  EXPECT_EQ(run.judge({"share(a, lights)"}, "smallest").verdict, Verdict::reproduced);
  const ClaimResult gather = run.judge({"share(a, gather)"}, "largest");
  EXPECT_EQ(gather.verdict, Verdict::not_reproduced);
  EXPECT_NEAR(*gather.value, 0.15, 1e-12);
  EXPECT_EQ(gather.reason.find("gather less build: -0.0500"), 0U) << gather.reason;
  ASSERT_EQ(gather.parts.size(), 4U) << "its share, and those of build, lights, transport";
  EXPECT_EQ(gather.parts[1].text, "share of build");
  // A nested stage is compared with top-level ones, but not with the one around it.
  EXPECT_EQ(run.judge({"share(a, build/bvh)"}, "largest").parts.size(), 4U);
  EXPECT_EQ(run.judge({"share(a, gather + build)"}, "largest").verdict, Verdict::not_reproduced);
}

TEST(ClaimVerdicts, OfMissingThingsAreInconclusiveWithWhatThereIs) {
  ClaimRun run;
  run.times(val(2), {1.0, 1.1});
  const auto reason = [&](const std::string& measure) {
    const ClaimResult result = run.judge({measure}, ">= 0");
    EXPECT_EQ(result.verdict, Verdict::inconclusive) << measure;
    EXPECT_FALSE(result.value);
    return result.reason;
  };
  EXPECT_EQ(reason("value(val[vals=30], total_s)"), "no row of this run is val[vals=30]");
  EXPECT_EQ(reason("count(val[vals=30])"), "no row of this run is val[vals=30]");
  EXPECT_EQ(reason("count(vla)"), "unknown method \"vla\"; known: val");
  EXPECT_EQ(reason("share(val, shadow)"),
            "unknown stage \"shadow\"; known: build, build/bvh, gather, lights, readback, "
            "transport");
  EXPECT_EQ(reason("value(val, counter.ray)"),
            "unknown counter \"ray\"; did you mean \"rays\"? known: links, rays");
  EXPECT_EQ(reason("value(val, relmse)"), "val[vals=2] on box at 64spp has no relmse");
  EXPECT_EQ(reason("value(val, next_frame_s)"), "val[vals=2] on box at 64spp has no next_frame_s");
  EXPECT_EQ(reason("r2(val, total_s, vals)"),
            "r2(val, total_s, vals) needs at least 3 rows; val "
            "selects 1");
  run.scores(val(2), "flip", {std::nan("")});
  EXPECT_EQ(reason("value(val, flip.p95)"), "flip.p95 of val[vals=2] on box at 64spp is no number");
  EXPECT_NE(reason("value(val, flip.p96)").find("details of flip: p95"), std::string::npos);
  EXPECT_EQ(reason("log2(0 - value(val, total_s))"), "the value is not a finite number");
  run.times(val(5), {2.0}).change([](results::CellRecord& cell) {
    cell.render.stages = {cell.render.stages[2]};
  });
  EXPECT_EQ(reason("share(val[vals=5], gather)"),
            "val[vals=5] on box at 64spp has no gather; it has: lights");
  EXPECT_EQ(reason("value(val, total_s)"),
            "value(val, total_s) needs exactly one row; 2 are val: val[vals=2] on box at 64spp, "
            "val[vals=5] on box at 64spp");
}

TEST(ClaimVerdicts, OfRowsWithFailuresOrMissingCellsAreInconclusive) {
  ClaimRun run;
  run.scores({"a"}, "relmse", {0.1, 0.1, 0.1}).times({"b"}, {1.0, 1.0});
  run.change([](results::CellRecord& cell) { cell.render.status = results::Status::timeout; });
  EXPECT_EQ(run.judge({"value(b, total_s)"}, "<= 2").reason,
            "b on box at 64spp is not complete: 1 ok, 1 timeout");
  EXPECT_EQ(run.value("count(b)"), 1.0);
  run.planned({"a"});
  EXPECT_EQ(run.judge({"value(a, relmse)"}, "<= 2").reason,
            "a on box at 64spp is not complete: 3 ok, 1 not yet");
  ClaimRun partly;
  partly.scores({"a"}, "relmse", {0.1, std::numeric_limits<double>::quiet_NaN(), 0.1});
  EXPECT_EQ(partly.judge({"value(a, relmse)"}, "<= 2").reason,
            "relmse of a on box at 64spp is finite for 2 of 3 seeds");
}

TEST(ClaimVerdicts, CountForTheirProfilesOnly) {
  const ClaimRun run = falling_run();
  results::claims::Claim claim = claim_of({"value(val[vals=2], relmse)"}, "<= 1");
  claim.profiles = {"paper"};
  const results::RunValues values(run.run());
  const ClaimResult other = evaluate(claim, values);
  EXPECT_EQ(other.verdict, Verdict::inconclusive);
  EXPECT_EQ(other.reason, "the run has profile half; the claim counts for paper");
  EXPECT_NEAR(*other.value, 0.4, 1e-12) << "the number is shown all the same";
  claim.profiles = {"paper", "half"};
  EXPECT_EQ(evaluate(claim, values).verdict, Verdict::reproduced);
}

TEST(ClaimVerdicts, OfWhatCannotBeComparedKeepTheNumbers) {
  const ClaimRun run = falling_run();
  results::claims::Claim claim = claim_of({"value(val[vals=2], relmse)"}, ">= 1");
  claim.comparable = results::claims::Comparable::no;
  claim.comparable_reason = "hardware time";
  const ClaimResult result = evaluate(claim, results::RunValues(run.run()));
  EXPECT_EQ(result.verdict, Verdict::not_comparable);
  EXPECT_EQ(result.reason, "hardware time");
  EXPECT_NEAR(*result.value, 0.4, 1e-12);
  EXPECT_EQ(run.judge({"value(val[vals=2], relmse)"}, "printed").verdict, Verdict::printed);
}

TEST(Claims, AreEvaluatedOneByOne) {
  const ClaimRun run = falling_run();
  const std::vector<results::claims::Claim> claims{
      claim_of({"value(nothing, relmse)"}, ">= 1"), claim_of({"not an expression"}, ">= 1"),
      claim_of({"value(val[vals=2], relmse)"}, "<= 1"),
      claim_of({"value(val[vals=2], relmse)"}, ">= 1")};
  const std::vector<ClaimResult> judged =
      results::claims::evaluate(claims, results::RunValues(run.run()));
  ASSERT_EQ(judged.size(), 4U);
  EXPECT_EQ(results::claims::format_counts(judged),
            "reproduced 1, not reproduced 1, inconclusive 2");
  EXPECT_FALSE(results::claims::all_reproduced(judged));
  EXPECT_TRUE(results::claims::all_reproduced(std::span(judged).subspan(2, 1)));
  EXPECT_FALSE(results::claims::all_reproduced({})) << "nothing was measured";
}

TEST(Claims, AreWrittenAsJson) {
  const ClaimRun run = falling_run();
  const std::vector<ClaimResult> judged{run.judge({"value(val[vals=2], relmse)"}, "<= 1"),
                                        run.judge({"value(val[vals=3], relmse)"}, "<= 1")};
  const nlohmann::ordered_json json = results::claims::to_json(judged);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["counts"], (nlohmann::ordered_json{{"reproduced", 1}, {"inconclusive", 1}}));
  EXPECT_EQ(json["all_reproduced"], false);
  const nlohmann::ordered_json& first = json["claims"][0];
  EXPECT_EQ(first["verdict"], "reproduced");
  EXPECT_NEAR(first["value"].get<double>(), 0.4, 1e-12);
  EXPECT_LE(first["low"].get<double>(), 0.4);
  EXPECT_EQ(first["parts"][0]["text"], "value(val[vals=2], relmse)");
  EXPECT_EQ(first["parts"][0]["rows"], 1);
  EXPECT_TRUE(json["claims"][1]["value"].is_null());
}

TEST(Claims, AreShownInTablesAndThePage) {
  const ClaimRun run = falling_run();
  std::vector<ClaimResult> judged{run.judge({"value(val[vals=2], relmse)"}, "<= 1")};
  judged.front().claim.says = "<b>";
  const std::string text = to_text(results::claims::claim_table(judged));
  EXPECT_NE(text.find("+ reproduced"), std::string::npos);
  EXPECT_NE(text.find("0.4000 [0.3"), std::string::npos) << text;
  const std::string page = results::html_report::claims_section(judged);
  EXPECT_NE(page.find("<b class=\"verdict reproduced\">✓ reproduced 1</b>"), std::string::npos);
  EXPECT_NE(page.find("<td>&lt;b&gt;<details>"), std::string::npos);
  EXPECT_EQ(results::html_report::claims_section({}), "");
}

TEST(Claims, StandInTheReportBetweenOverviewAndScenes) {
  ClaimRun run = falling_run();
  EXPECT_EQ(results::html_report::html_report(run.run()).find("id=\"claims\""), std::string::npos);
  run.claims({claim_of({"series(val, relmse, vals) / 2"}, "falls"),
              claim_of({"share(val[vals=2], gather)"}, "largest")});
  const std::string page = results::html_report::html_report(run.run());
  const std::size_t place = page.find("<section id=\"claims\">");
  ASSERT_NE(place, std::string::npos);
  EXPECT_LT(page.find("id=\"overview\""), place);
  EXPECT_GT(page.find("id=\"scene-1\""), place);
  EXPECT_NE(page.find("<a href=\"#claims\">Claims</a>"), std::string::npos);
  EXPECT_NE(page.find("<td>0.2000, 0.1000, 0.05000</td>"), std::string::npos);
  EXPECT_NE(page.find("gather less build: -0.0500"), std::string::npos);
}

TEST(ClaimChecks, TellBeforeARunWhatCannotBe) {
  ClaimRun run;
  run.planned(val(2)).planned(val(5)).planned({"pt"});
  const auto error = [&](const std::string& measure, const char* profile = "half") {
    results::claims::Claim claim = claim_of({measure}, ">= 1");
    claim.measure_places = {{"s.yaml", 7, 10}};
    claim.profiles = {profile};
    const results::RunValues planned(run.run());
    return tests::input_error_of([&] { results::claims::check_claims({&claim, 1}, planned); });
  };
  EXPECT_EQ(error("share(val, gather/visibility + shadow) * sum(*, counter.rays)"), "no error");
  EXPECT_EQ(error("r2(val, shadow, vals * faces) + median(pt[scene=box], flip.p95@full)"),
            "no error");
  EXPECT_EQ(error("greatest(series(val, relmse, vals), series(*, relmse, scene))"), "no error");
  EXPECT_EQ(error("count(vla)"), "s.yaml:7:16: unknown method \"vla\"; known: val, pt");
  EXPECT_EQ(error("count(pt[vals=2])").substr(0, 32), "s.yaml:7:19: unknown key \"vals\";");
  EXPECT_EQ(error("median(val, ssim)").substr(0, 36), "s.yaml:7:22: unknown metric \"ssim\"; ");
  EXPECT_EQ(error("median(val, ssim@full)").substr(0, 36),
            "s.yaml:7:22: unknown metric \"ssim\"; ");
  EXPECT_EQ(error("median(val, parameter.depth)").substr(0, 40),
            "s.yaml:7:22: unknown parameter \"depth\"; ");
  EXPECT_EQ(error("value(val, relmse)"),
            "s.yaml:7:16: value is of exactly one row; 2 are val: narrow it, e.g. "
            "val[scene=...], or take median(...)");
  EXPECT_EQ(error("value(val, relmse)", "paper"), "no error") << "rows of another profile";
}

}  // namespace
