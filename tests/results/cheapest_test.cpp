#include "results/cheapest.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/results/claims/claim_run.h"

namespace test_results {
namespace {

using namespace results;

/// A method whose every seed took so long.
void add(ClaimRun& run, const std::string& method, double seconds,
         const std::vector<double>& scores, const std::string& scene = "box") {
  run.scores({method, "", 0, scene}, "flip", scores);
  run.each_record([&](CellRecord& record) {
    if (record.method == method && record.scene == scene) {
      record.render.total_s = seconds * (1.0 + 0.001 * static_cast<double>(record.render.seed));
    }
  });
}

TEST(Cheapest, IsTheLeastTimeBelowTheLimit) {
  ClaimRun run;
  add(run, "coarse", 0.1, {0.20, 0.21, 0.22});
  add(run, "unsure", 0.5, {0.04, 0.05, 0.06});
  add(run, "good", 1.0, {0.030, 0.031, 0.032});
  add(run, "fine", 9.0, {0.010, 0.011, 0.012});
  const auto scenes = cheapest_settings(RunValues(run.run()), "flip", "own", 0.05);
  ASSERT_EQ(scenes.size(), 1U);
  ASSERT_EQ(scenes[0].candidates.size(), 4U);
  const Candidate& best = scenes[0].candidates[0];
  EXPECT_EQ(best.method, "good");
  EXPECT_TRUE(best.is_cheapest);
  EXPECT_EQ(scenes[0].candidates[1].method, "fine");
  EXPECT_FALSE(scenes[0].candidates[1].is_tied);
  EXPECT_EQ(scenes[0].candidates[2].visibility, Visibility::above);
  EXPECT_EQ(scenes[0].candidates[3].visibility, Visibility::undecided);
  const Table table = cheapest_table(scenes, "flip (own)", 0.05);
  EXPECT_EQ(table.rows[0][1].text, "good");
  EXPECT_EQ(table.rows[0].back().text, "cheapest");
  EXPECT_EQ(to_json(scenes)[0].at("cheapest").at("method"), "good");
}

TEST(Cheapest, SaysWhichAreAsFast) {
  ClaimRun run;
  add(run, "a", 1.0, {0.01, 0.01});
  add(run, "b", 1.0005, {0.02, 0.02});
  const auto scenes = cheapest_settings(RunValues(run.run()), "flip", "own", 0.05);
  EXPECT_TRUE(scenes[0].candidates[0].is_cheapest);
  EXPECT_TRUE(scenes[0].candidates[1].is_tied);
}

TEST(Cheapest, OfNothingIsNothing) {
  ClaimRun run;
  add(run, "a", 1.0, {0.5, 0.5});
  add(run, "b", 1.0, {0.5, 0.5}, "hall");
  const auto scenes = cheapest_settings(RunValues(run.run()), "flip", "own", 0.05);
  ASSERT_EQ(scenes.size(), 2U);
  EXPECT_TRUE(to_json(scenes)[1].at("cheapest").is_null());
}

/// An error of the reference is none of the method.
TEST(Cheapest, AReferenceThatIsTooNoisyDecidesNothing) {
  ClaimRun run;
  add(run, "a", 1.0, {0.5, 0.5});
  run.noise_floor(0.2);
  const auto scenes = cheapest_settings(RunValues(run.run()), "flip", "own", 0.05);
  EXPECT_EQ(scenes[0].candidates[0].visibility, Visibility::undecided);
}

TEST(Cheapest, RefusesWhatIsNoError) {
  ClaimRun run;
  run.metric("ssim");
  run.scores({"a"}, "ssim", {0.9});
  EXPECT_THROW(cheapest_settings(RunValues(run.run()), "ssim", "own", 0.5), base::InputError);
  EXPECT_THROW(cheapest_settings(RunValues(run.run()), "total_s", "own", 0.5), base::InputError);
  EXPECT_THROW(cheapest_settings(RunValues(run.run()), "flop", "own", 0.5), base::InputError);
}

}  // namespace
}  // namespace test_results
