#include "suites/stage_sums.h"

#include <gtest/gtest.h>

namespace {

using renderers::Phase;
using renderers::StageRecord;

StageRecord stage(Phase phase, const std::string& path, double wall_s) {
  StageRecord record;
  record.phase = phase;
  record.path = path;
  record.wall_s = wall_s;
  record.cpu_s = 2.0 * wall_s;
  record.calls = 1;
  return record;
}

TEST(StageSums, ReadbackCountsAtAnyDepthAndOnce) {
  const std::vector<StageRecord> stages{
      stage(Phase::render, "transport", 5.0), stage(Phase::render, "transport/readback", 1.0),
      stage(Phase::render, "transport/readback/readback", 0.5),
      stage(Phase::render, "readback", 0.25), stage(Phase::render, "not-readback", 8.0)};
  EXPECT_DOUBLE_EQ(suites::readback_s(stages), 1.25);
}

TEST(StageSums, TopLevelStagesOfAllPhasesAreSummed) {
  const std::vector<StageRecord> stages{stage(Phase::prepare, "build", 2.0),
                                        stage(Phase::prepare, "build/bvh", 1.5),
                                        stage(Phase::render, "transport", 3.0)};
  EXPECT_DOUBLE_EQ(suites::top_level_s(stages), 5.0);
}

TEST(StageSums, CheckpointsLeaveTheStagesAroundThem) {
  const std::vector<StageRecord> stages{
      stage(Phase::prepare, "transport", 7.0), stage(Phase::render, "transport", 5.0),
      stage(Phase::render, "transport/trace", 4.0),
      stage(Phase::render, "transport/trace/checkpoint_sink", 1.0),
      stage(Phase::render, "checkpoint_sink", 0.5)};
  const auto kept = suites::without_checkpoints(stages);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_DOUBLE_EQ(kept[0].wall_s, 7.0);
  EXPECT_DOUBLE_EQ(kept[1].wall_s, 4.0);
  EXPECT_DOUBLE_EQ(kept[1].cpu_s, 8.0);
  EXPECT_DOUBLE_EQ(kept[2].wall_s, 3.0);
}

}  // namespace
