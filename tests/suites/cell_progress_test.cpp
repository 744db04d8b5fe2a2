#include "suites/cell_progress.h"

#include <gtest/gtest.h>

namespace {

using results::Status;
using suites::CellProgress;

results::CellRecord record(int repetition, double total_s, Status status = Status::ok) {
  results::CellRecord made;
  made.repetition = repetition;
  made.render.status = status;
  made.render.total_s = total_s;
  made.render.image = "images/a/frame.exr";
  made.render.pixel_hash = "abc";
  return made;
}

suites::MeasurePlan plan(int min, int max, double until = 0.05) {
  suites::MeasurePlan made;
  made.min_repetitions = min;
  made.max_repetitions = max;
  made.until_relative_spread = until;
  return made;
}

/// How many repetitions a cell gets whose times come in this order, over and over.
int repetitions_of(const std::vector<double>& times, const suites::MeasurePlan& measure) {
  CellProgress progress;
  while (progress.needs_more(measure)) {
    const int next = progress.next_repetition();
    progress.add(record(next, times[static_cast<std::size_t>(next) % times.size()]));
  }
  return static_cast<int>(progress.repetitions());
}

TEST(CellProgress, StopsAtMinWhenTheTimesAgree) {
  EXPECT_EQ(repetitions_of({1.0}, plan(7, 30)), 7);
  EXPECT_EQ(repetitions_of({1.0}, plan(1, 1)), 1);
}

TEST(CellProgress, AnIntervalTakesSixValues) { EXPECT_EQ(repetitions_of({1.0}, plan(1, 9)), 6); }

TEST(CellProgress, GoesOnToMaxWhileTheMedianIsUncertain) {
  EXPECT_EQ(repetitions_of({1.0, 2.0}, plan(3, 12)), 12);
}

TEST(CellProgress, StopsBetweenMinAndMaxOnceTheIntervalIsTight) {
  // Two slow ones at first, then steady: the median settles long before 40.
  CellProgress progress;
  const suites::MeasurePlan measure = plan(3, 40);
  while (progress.needs_more(measure)) {
    const int next = progress.next_repetition();
    progress.add(record(next, next < 2 ? 2.0 : 1.0));
  }
  EXPECT_GT(progress.repetitions(), 3U);
  EXPECT_LT(progress.repetitions(), 40U);
}

TEST(CellProgress, LongPrepareIsRepeatedMinTimesOnly) {
  CellProgress progress;
  for (int i = 0; i < 3; ++i) {
    results::CellRecord one = record(i, i == 0 ? 11.0 : 20.0);
    one.render.prepare_s = 10.5;
    EXPECT_TRUE(progress.needs_more(plan(3, 30)));
    progress.add(one);
  }
  EXPECT_FALSE(progress.needs_more(plan(3, 30)));
}

TEST(CellProgress, FailuresThatWouldRepeatThemselvesEndACellAtOnce) {
  for (const Status status : {Status::timeout, Status::out_of_memory, Status::unsupported}) {
    CellProgress progress;
    progress.add(record(0, 0.0, status));
    EXPECT_FALSE(progress.needs_more(plan(3, 9))) << to_string(status);
    EXPECT_EQ(progress.has_failed(), status != Status::unsupported);
    EXPECT_EQ(progress.was_skipped(), status == Status::unsupported);
  }
}

TEST(CellProgress, ACrashCostsOneRepetition) {
  CellProgress progress;
  results::CellRecord crash = record(0, 0.0, Status::crash);
  crash.render.image.clear();
  progress.add(crash);
  EXPECT_TRUE(progress.needs_more(plan(2, 9)));
  EXPECT_EQ(progress.next_repetition(), 1);
  progress.add(record(1, 1.0));
  EXPECT_FALSE(progress.needs_more(plan(2, 9)));
  EXPECT_TRUE(progress.has_failed());
  EXPECT_EQ(progress.image(), "images/a/frame.exr");
}

TEST(CellProgress, TheFirstImageIsTheOneThatIsScored) {
  CellProgress progress;
  progress.add(record(0, 1.0));
  results::CellRecord other = record(1, 1.0);
  other.render.image = "images/a/frame-r001.exr";
  other.render.pixel_hash = "def";
  progress.add(other);
  EXPECT_EQ(progress.image(), "images/a/frame.exr");
  EXPECT_EQ(progress.pixel_hash(), "abc");
}

}  // namespace
