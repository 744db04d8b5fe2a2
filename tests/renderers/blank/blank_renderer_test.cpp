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

}  // namespace
}  // namespace renderers::test
