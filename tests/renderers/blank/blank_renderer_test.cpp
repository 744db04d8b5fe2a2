#include "renderers/blank/blank_renderer.h"

#include <new>
#include <string>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

Frame blank(const std::vector<std::string>& settings) {
  return render({}, {.renderer = "blank", .settings = settings, .width_px = 7, .height_px = 5});
}

TEST(Blank, IsBlackAndOfTheRightSize) {
  const Frame frame = blank({});
  EXPECT_EQ(frame.radiance.width_px, 7);
  EXPECT_EQ(frame.radiance.height_px, 5);
  for (const float value : frame.radiance.pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_EQ(frame.samples, 0);
}

TEST(Blank, HasTheRadianceAskedFor) {
  EXPECT_EQ(blank({"radiance=2.5"}).radiance.at(6, 4, 2), 2.5F);
}

TEST(Blank, WritesOneNan) {
  EXPECT_EQ(perception::count_non_finite(blank({"behaviour=nan"}).radiance).pixels, 1U);
}

TEST(Blank, FailsByExceptionWhereAsked) {
  EXPECT_THROW(blank({"behaviour=exception"}), base::DeviceError);
  EXPECT_THROW(blank({"behaviour=out_of_memory"}), std::bad_alloc);
}

TEST(BlankDeathTest, CrashesWhereAsked) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(blank({"behaviour=crash"}), testing::KilledBySignal(SIGABRT), "");
}

TEST(Blank, PrintsThreeMebibytes) {
  testing::internal::CaptureStdout();
  blank({"behaviour=print"});
  EXPECT_EQ(testing::internal::GetCapturedStdout().size(), std::size_t{3} << 20);
}

TEST(Blank, SleepsForTheTimeAskedFor) {
  const double start_s = steady_seconds();
  blank({"sleep_s=0.05"});
  EXPECT_GE(steady_seconds() - start_s, 0.05);
}

TEST(Blank, SleepsInTheStageNamed) {
  StageTimer timer;
  render({}, {.renderer = "blank", .settings = {"prepare_sleep_s=0.02", "readback_sleep_s=0.03"}},
         &timer);
  EXPECT_GE(timer.wall_of("build"), 0.02);
  EXPECT_GE(timer.wall_of("readback"), 0.03);
}

TEST(Blank, HandsOverCheckpointsAndTellsItsTimeBudget) {
  std::vector<std::int64_t> samples;
  RenderRequest request{.renderer = "blank", .settings = {"checkpoints=3"}};
  request.change_job = [&](RenderJob& job) {
    job.time_budget_s = 0.25;
    job.checkpoint = [&](const perception::Image&, std::int64_t done) { samples.push_back(done); };
  };
  const Frame frame = render({}, request);
  EXPECT_EQ(samples, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(counter(frame, "time_budget_s"), 0.25);
  EXPECT_GE(counter(frame, "checkpoint_s"), 0.0);
  EXPECT_TRUE(blank({"checkpoints=3"}).counters.empty()) << "no sink, no budget";
}

/// The frame with this number of a renderer with these settings, as one that was prepared earlier.
Frame next_frame(const std::vector<std::string>& settings, int frame_index, StageTimer& timer) {
  const RendererInfo& info = find_renderer("blank", {});
  std::vector<base::ParameterSetting> parsed;
  for (const std::string& text : settings) parsed.push_back(base::parse_setting(text, "test"));
  const auto renderer = info.create(
      base::resolve_parameters(info.parameters, &find_preset(info, "best", {}), parsed, "test"),
      {1, "auto", nullptr});
  timer.set_phase(Phase::update);
  renderer->update({}, timer);
  RenderJob job;
  job.width_px = 2;
  job.height_px = 2;
  job.frame_index = frame_index;
  return renderer->render(job, timer);
}

TEST(Blank, UpdatesInItsOwnTime) {
  StageTimer timer;
  next_frame({"prepare_sleep_s=10", "update_sleep_s=0.02"}, 1, timer);
  EXPECT_GE(timer.wall_of("scene_update"), 0.02);
  EXPECT_EQ(timer.wall_of("build"), 0.0);
}

TEST(Blank, FramesDifferWhereAsked) {
  StageTimer timer;
  const std::vector<std::string> settings{"radiance=1", "radiance_per_frame=0.5"};
  EXPECT_EQ(next_frame(settings, 0, timer).radiance.at(0, 0), 1.0F);
  EXPECT_EQ(next_frame(settings, 3, timer).radiance.at(0, 0), 2.5F);
}

TEST(Blank, FailsAtTheFrameAskedFor) {
  StageTimer timer;
  const std::vector<std::string> settings{"behaviour=unsupported", "fail_at_frame=2"};
  EXPECT_NO_THROW(next_frame(settings, 1, timer));
  EXPECT_THROW(next_frame(settings, 2, timer), UnsupportedError);
  EXPECT_THROW(next_frame({"behaviour=unsupported"}, 1, timer), UnsupportedError);
  EXPECT_EQ(perception::count_non_finite(
                next_frame({"behaviour=nan", "fail_at_frame=2"}, 1, timer).radiance)
                .pixels,
            0U);
}

}  // namespace
}  // namespace renderers::test
