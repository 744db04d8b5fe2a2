#include "suites/frame_range.h"

#include <gtest/gtest.h>

#include "suites/suite_scenes.h"
#include "tests/expect_input_error.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace {

using suites::FrameRange;
using suites::Suite;

const std::string kViewing = "schema: 1\nsuite: trial\nviewing: {ppd: 60}\n";
const std::string kMethods = "methods: [{id: b, renderer: blank}]\n";

class Frames : public testing::Test {
 protected:
  Suite suite(const std::string& entry, const std::string& rest = "",
              const std::string& profile = "") {
    return tests::suite_from(
        folder_.path(),
        kViewing + "scenes: [{id: moving, file: moving.yaml, " + entry + "}]\n" + kMethods + rest,
        profile);
  }
  FrameRange frames(const std::string& entry) { return suite(entry).scenes.at(0).frames; }
  std::string error_of(const std::string& entry) {
    return tests::input_error_of([&] { suites::load_scenes(suite(entry)); });
  }

  tests::TemporaryFolder folder_;
};

TEST_F(Frames, AreOneOrASequence) {
  EXPECT_EQ(frames("size: [8, 8]").numbers(), (std::vector<int>{0}));
  EXPECT_EQ(frames("frame: 4").numbers(), (std::vector<int>{4}));
  EXPECT_FALSE(frames("frame: 4").is_sequence);
  EXPECT_EQ(frames("frames: [1, 3]").numbers(), (std::vector<int>{1, 2, 3}));
  EXPECT_TRUE(frames("frames: [1, 3]").is_sequence);
  EXPECT_EQ(frames("frames: {first: 0, last: 5, step: 2}").numbers(), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(frames("frames: {first: 3, last: 3}").numbers(), (std::vector<int>{3}));
}

TEST_F(Frames, AreReplacedByAProfile) {
  const std::string profiles =
      "profiles: {smoke: {scenes: {moving: {frames: {last: 2}}}}, "
      "half: {scenes: {moving: {frames: [1, 2]}}}}\n";
  const std::string entry = "frames: {first: 0, last: 5, step: 1}";
  EXPECT_EQ(suite(entry, profiles, "smoke").scenes[0].frames.numbers(),
            (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(suite(entry, profiles, "half").scenes[0].frames.numbers(), (std::vector<int>{1, 2}));
}

TEST_F(Frames, SurviveTheResolvedForm) {
  const Suite made = suite("frames: {first: 0, last: 5, step: 2}", "measure: {new_view: true}\n");
  EXPECT_TRUE(made.measure.has_new_view);
  const std::string text = suites::resolved_yaml(made);
  const Suite again = suites::parse_suite(base::parse_document(text, "resolved.yaml"),
                                          folder_.path() / "resolved.yaml", "");
  EXPECT_EQ(again.scenes[0].frames.numbers(), (std::vector<int>{0, 2, 4}));
  EXPECT_TRUE(again.scenes[0].frames.is_sequence);
  EXPECT_TRUE(again.measure.has_new_view);
  EXPECT_EQ(suites::resolved_yaml(again), text);
}

TEST_F(Frames, ErrorsSayWhatIsAccepted) {
  EXPECT_EQ(error_of("frame: 1, frames: [0, 3]"),
            "trial.yaml:4:52: a scene has either frame or frames; found both");
  EXPECT_EQ(error_of("frames: [3, 1]"),
            "trial.yaml:4:50: the last of frames, 1, is before the first, 3");
  EXPECT_EQ(error_of("frames: [0, 1, 2]"),
            "trial.yaml:4:50: frames must be [first, last] or {first, last, step}, e.g. [0, 59]");
  EXPECT_EQ(error_of("frames: 7"),
            "trial.yaml:4:50: frames must be [first, last] or {first, last, step}, e.g. [0, 59]");
  EXPECT_EQ(error_of("frames: [-1, 2]"), "trial.yaml:4:51: first is -1; accepted: 0 to 1000000");
  EXPECT_EQ(error_of("frames: {first: 0, last: 3, step: 0}"),
            "trial.yaml:4:76: step is 0; accepted: 1 to 1000000");
  EXPECT_EQ(error_of("frames: {first: 0, last: 3, stride: 2}"),
            "trial.yaml:4:70: unknown key \"stride\"; known: first, last, step in frames");
  EXPECT_EQ(error_of("frames: {last: 3}"),
            "trial.yaml:4:50: frames has no \"first\"; it is required");
  EXPECT_EQ(error_of("frame: -2"), "trial.yaml:4:49: frame is -2; accepted: 0 to 1000000");
}

TEST_F(Frames, GoNoFurtherThanTheScene) {
  EXPECT_EQ(error_of("frames: [0, 5]"), "no error");
  EXPECT_EQ(error_of("frames: [0, 6]"),
            "trial.yaml:4:50: frames go to 6; accepted: 0 to 5, the frames of scene "
            "\"moving-block\"");
  // A single frame beyond the last key shows what the key holds.
  EXPECT_EQ(error_of("frame: 60"), "no error");
}

TEST_F(Frames, OfOneStateShareIt) {
  const auto scenes = suites::load_scenes(suite("frames: [0, 5]"));
  ASSERT_EQ(scenes.size(), 1U);
  const auto& states = scenes[0].frames;
  ASSERT_EQ(states.size(), 6U);
  EXPECT_EQ(states[1], states[0]);
  EXPECT_EQ(states[2], states[0]);
  EXPECT_NE(states[3], states[2]);
  EXPECT_NE(states[4]->hash, states[3]->hash);
  EXPECT_EQ(&scenes[0].first(), states[0].get());
}

}  // namespace
