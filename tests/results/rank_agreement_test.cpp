#include "results/rank_agreement.h"

#include <gtest/gtest.h>

#include "tests/results/claims/claim_run.h"

namespace test_results {
namespace {

using namespace results;

RankAgreement agreement_of(const ClaimRun& run) {
  const RunValues values(run.run());
  const auto scenes =
      rank_agreement(values, values.find_quantity("relmse", {}), values.find_quantity("flip", {}));
  EXPECT_EQ(scenes.size(), 1U);
  return scenes.front();
}

TEST(RankAgreement, NamesPairsThatTwoScoresOrderDifferently) {
  ClaimRun run;
  run.scores({"noisy"}, "relmse", {0.1, 0.11, 0.12}).scores({"noisy"}, "flip", {0.5, 0.51, 0.52});
  run.scores({"biased"}, "relmse", {0.3, 0.31, 0.32}).scores({"biased"}, "flip", {0.1, 0.11, 0.12});
  run.scores({"bad"}, "relmse", {0.9, 0.91, 0.92}).scores({"bad"}, "flip", {0.9, 0.91, 0.92});
  const RankAgreement scene = agreement_of(run);
  EXPECT_EQ(scene.rows, 3U);
  EXPECT_EQ(scene.pairs, 3U);
  ASSERT_EQ(scene.disagreements.size(), 1U);
  EXPECT_EQ(run.run().cells[scene.disagreements[0].first * 3].method, "noisy");
  EXPECT_NEAR(*scene.tau, 1.0 / 3.0, 1e-12);
}

/// An order that noise may have made is none.
TEST(RankAgreement, LeavesPairsInDoubtOut) {
  ClaimRun run;
  run.scores({"a"}, "relmse", {0.1, 0.2, 0.3}).scores({"a"}, "flip", {0.5, 0.51, 0.52});
  run.scores({"b"}, "relmse", {0.15, 0.25, 0.35}).scores({"b"}, "flip", {0.1, 0.11, 0.12});
  const RankAgreement scene = agreement_of(run);
  EXPECT_EQ(scene.pairs, 0U);
  EXPECT_FALSE(scene.tau);
  const RunValues values(run.run());
  const Table table = rank_agreement_table(values, values.find_quantity("relmse", {}),
                                           values.find_quantity("flip", {}));
  EXPECT_TRUE(table.rows.empty());
  EXPECT_EQ(table.notes[0], "box: 2 rows, no pair that both scores tell apart");
}

}  // namespace
}  // namespace test_results
