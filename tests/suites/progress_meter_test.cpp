#include "suites/progress_meter.h"

#include <thread>

#include <gtest/gtest.h>

namespace {

TEST(ProgressMeter, CountsStepsAndScalesTheElapsedTimeByWork) {
  suites::Progress last;
  suites::ProgressMeter meter([&](const suites::Progress& progress) { last = progress; });
  meter.plan(1, 30.0);
  meter.plan(3, 90.0);
  meter.begin_step("first", 30.0);
  EXPECT_EQ(last.activity, "first");
  EXPECT_EQ(last.total, 4U);
  EXPECT_LT(last.remaining_s, 0.0);  // nothing is done: not known
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  meter.show(0.5);
  // 15 of 120 done: seven times as long is to come.
  EXPECT_NEAR(last.remaining_s, 7.0 * last.elapsed_s, 1e-9);
  meter.finish_step();
  EXPECT_EQ(last.done, 1U);
  EXPECT_NEAR(last.remaining_s, 3.0 * last.elapsed_s, 1e-9);
}

TEST(ProgressMeter, StepsBeyondThePlanCountToo) {
  suites::Progress last;
  suites::ProgressMeter meter([&](const suites::Progress& progress) { last = progress; });
  meter.begin_step("unplanned", 1.0);
  meter.finish_step();
  EXPECT_EQ(last.done, 1U);
  EXPECT_EQ(last.total, 1U);
  EXPECT_GE(last.remaining_s, 0.0);
}

}  // namespace
