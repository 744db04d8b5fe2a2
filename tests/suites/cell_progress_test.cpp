#include "suites/cell_progress.h"

#include <cmath>
#include <optional>
#include <utility>

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
  EXPECT_EQ(progress.image(0), "images/a/frame.exr");
}

TEST(CellProgress, TheFirstImageIsTheOneThatIsScored) {
  CellProgress progress;
  progress.add(record(0, 1.0));
  results::CellRecord other = record(1, 1.0);
  other.render.image = "images/a/frame-r001.exr";
  other.render.pixel_hash = "def";
  progress.add(other);
  EXPECT_EQ(progress.image(0), "images/a/frame.exr");
  EXPECT_EQ(progress.pixel_hash(0), "abc");
}

/// A frame of a sequence's repetition, as it comes from a run.
results::CellRecord frame_record(int repetition, int frame, Status status = Status::ok) {
  results::CellRecord made = record(repetition, 1.0, status);
  made.render.frame = frame;
  made.render.image = "images/a/frame-" + std::to_string(frame) + ".exr";
  made.render.pixel_hash = "hash " + std::to_string(frame);
  if (frame > 0) {
    made.render.total_s = std::nan("");
    made.render.prepare_s = std::nan("");
    made.render.next_frame_s = 0.5;
  }
  return made;
}

TEST(CellProgress, ASequenceIsFinishedWithItsLastFrame) {
  CellProgress progress(3);
  for (const int frame : {0, 1}) {
    progress.add(frame_record(0, frame));
    EXPECT_EQ(progress.repetitions(), 0U);
    EXPECT_EQ(progress.next_repetition(), 0);
    EXPECT_TRUE(progress.needs_more(plan(1, 1)));
  }
  progress.add(frame_record(0, 2));
  EXPECT_EQ(progress.repetitions(), 1U);
  EXPECT_EQ(progress.next_repetition(), 1);
  EXPECT_FALSE(progress.needs_more(plan(1, 1)));
  EXPECT_EQ(progress.image(1), "images/a/frame-1.exr");
  EXPECT_EQ(progress.pixel_hash(2), "hash 2");
  EXPECT_EQ(progress.image(7), "");
}

TEST(CellProgress, AnInterruptedSequenceStartsAnewUnderItsNumber) {
  CellProgress progress(2);
  progress.add(frame_record(0, 0));
  progress.add(frame_record(0, 1));
  progress.add(frame_record(1, 0));
  EXPECT_EQ(progress.next_repetition(), 1);
  progress.add(frame_record(1, 0));
  progress.add(frame_record(1, 1));
  EXPECT_EQ(progress.repetitions(), 2U);
  EXPECT_EQ(progress.next_repetition(), 2);
}

TEST(CellProgress, AFrameThatFailsEndsItsRepetition) {
  CellProgress progress(5);
  progress.add(frame_record(0, 0));
  progress.add(frame_record(0, 1, Status::crash));
  EXPECT_EQ(progress.repetitions(), 1U);
  EXPECT_EQ(progress.next_repetition(), 1);
  EXPECT_TRUE(progress.has_failed());
  EXPECT_TRUE(progress.needs_more(plan(2, 9)));
  progress.add(frame_record(1, 0, Status::timeout));
  EXPECT_FALSE(progress.needs_more(plan(3, 9)));
}

TEST(CellProgress, PixelsThatAreNoNumbersDoNotEndASequence) {
  CellProgress progress(3);
  progress.add(frame_record(0, 0));
  progress.add(frame_record(0, 1, Status::non_finite));
  EXPECT_EQ(progress.repetitions(), 0U);
  progress.add(frame_record(0, 2));
  EXPECT_EQ(progress.repetitions(), 1U);
  EXPECT_TRUE(progress.has_failed());
}

/// How many repetitions a sequence gets whose first frame and whose following frames
/// take these seconds in even and in odd repetitions.
int sequence_repetitions_of(const std::vector<double>& first_s, const std::vector<double>& next_s,
                            double last_frame_s = 0.0) {
  constexpr int kFrames = 4;
  const suites::MeasurePlan measure = plan(3, 12);
  CellProgress progress(kFrames);
  while (progress.needs_more(measure)) {
    const int repetition = progress.next_repetition();
    const auto parity = static_cast<std::size_t>(repetition % 2);
    for (int frame = 0; frame < kFrames; ++frame) {
      results::CellRecord one = frame_record(repetition, frame);
      if (frame == 0) one.render.total_s = first_s[parity];
      if (frame > 0) one.render.next_frame_s = next_s[parity];
      if (frame == 3 && last_frame_s > 0.0) one.render.next_frame_s = last_frame_s * repetition;
      progress.add(one);
    }
  }
  return static_cast<int>(progress.repetitions());
}

TEST(CellProgress, ASequenceGoesOnUntilItsFollowingFramesAgree) {
  EXPECT_EQ(sequence_repetitions_of({1.0, 1.0}, {0.5, 0.5}), 6);
  EXPECT_EQ(sequence_repetitions_of({1.0, 1.0}, {0.5, 0.9}), 12);
  // The first frame has no say: its cold start may be as unsteady as it likes.
  EXPECT_EQ(sequence_repetitions_of({1.0, 9.0}, {0.5, 0.5}), 6);
  // A repetition counts with the median of its frames: one slow frame is no reason to go on.
  EXPECT_EQ(sequence_repetitions_of({1.0, 1.0}, {0.5, 0.5}, 7.0), 6);
}

results::CellRecord record_of(const std::string& device, std::optional<std::string> gl_platform,
                              Status status = Status::ok) {
  results::CellRecord made = record(0, 1.0, status);
  made.render.device = device;
  made.render.gl_platform = std::move(gl_platform);
  return made;
}

TEST(CellProgress, TheFirstSuccessSaysWhichDeviceACellIsOf) {
  CellProgress progress;
  EXPECT_EQ(progress.device(), "");
  progress.add(record_of("cpu", std::nullopt, Status::crash));
  progress.add(record_of("cpu", std::nullopt, Status::unsupported));
  EXPECT_EQ(progress.device(), "");
  progress.add(record_of("llvmpipe", "egl-surfaceless"));
  EXPECT_EQ(progress.device(), "llvmpipe (egl-surfaceless)");
  progress.add(record_of("llvmpipe", "osmesa"));
  EXPECT_EQ(progress.device(), "llvmpipe (egl-surfaceless)");
}

TEST(DeviceText, NamesThePlatformWhereThereIsOne) {
  EXPECT_EQ(suites::device_text(record_of("cpu", std::nullopt).render), "cpu");
  EXPECT_EQ(suites::device_text(record_of("llvmpipe", "osmesa").render), "llvmpipe (osmesa)");
}

}  // namespace
