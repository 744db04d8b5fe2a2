#include "renderers/opengl/gpu_stage.h"

#include <array>

#include <gtest/gtest.h>

#include "renderers/opengl/program.h"
#include "tests/renderers/opengl/platform_test.h"

namespace renderers::opengl {
namespace {

class GpuStageGlTest : public PlatformTest {
 protected:
  /// Work that takes a few milliseconds on a CPU and some microseconds on any device.
  void work() {
    static constexpr std::array kFiles{ShaderFile{"test/work.comp.glsl",
                                                  R"(layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Numbers { float numbers[]; };
void main() {
  float x = float(gl_GlobalInvocationID.x);
  for (int i = 0; i < 1000; ++i) x = sin(x) + 1.0;
  numbers[gl_GlobalInvocationID.x] = x;
}
)"}};
    Program& program = context_->program({kFiles, {"test/work.comp.glsl"}});
    if (numbers_.id() == 0) numbers_ = Buffer(context_, 4096 * sizeof(float));
    program.storage(0, numbers_);
    program.dispatch(64);
  }

  Buffer numbers_;
};
INSTANTIATE_TEST_SUITE_P(Platforms, GpuStageGlTest, all_platforms(), platform_label);

TEST_P(GpuStageGlTest, NestsAndReadsItsOwnClock) {
  work();
  StageTimer timer;
  {
    const GpuStage outer(*context_, timer, "gather");
    for (int i = 0; i < 3; ++i) {
      GpuStage inner(*context_, timer, "lights");
      work();
      inner.add_bytes(1, 10);
    }
  }
  ASSERT_EQ(timer.records().size(), 2U);
  const StageRecord& outer = timer.records()[0];
  const StageRecord& inner = timer.records()[1];
  EXPECT_EQ(inner.path, "gather/lights");
  EXPECT_EQ(inner.calls, 3);
  EXPECT_EQ(inner.bytes_gpu, 30);
  const StageClock clock = context_->is_software() ? StageClock::finish : StageClock::gpu_query;
  for (const StageRecord& record : timer.records()) {
    EXPECT_EQ(record.clock, clock);
    EXPECT_GT(record.gpu_s, 0.0);
    EXPECT_LE(record.gpu_s, record.wall_s);
  }
  EXPECT_GE(outer.gpu_s, inner.gpu_s);
}

/// Work started before the stage is not the stage's: an empty stage after unfinished work costs
/// less than that work.
TEST_P(GpuStageGlTest, DoesNotPayForWhatCameBefore) {
  work();
  StageTimer timer;
  {
    const GpuStage stage(*context_, timer, "gather");
    for (int i = 0; i < 8; ++i) work();
  }
  for (int i = 0; i < 8; ++i) work();
  { const GpuStage stage(*context_, timer, "filter"); }
  EXPECT_LT(timer.wall_of("filter"), timer.wall_of("gather"));
}

}  // namespace
}  // namespace renderers::opengl
