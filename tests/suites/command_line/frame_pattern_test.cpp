#include "suites/command_line/frame_pattern.h"

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"

namespace tests {
namespace {

using suites::command_line::FramePattern;
using suites::command_line::has_frame_number;
using suites::command_line::parse_frames;

std::string file_of(const char* pattern, int frame) {
  return FramePattern(pattern, {}).file(frame);
}

TEST(FramePatternOf, WritesNumbersAsPrintfAndImageToolsDo) {
  EXPECT_EQ(file_of("a-%d.exr", 7), "a-7.exr");
  EXPECT_EQ(file_of("a-%04d.exr", 7), "a-0007.exr");
  EXPECT_EQ(file_of("a-%04d.exr", 12345), "a-12345.exr");
  EXPECT_EQ(file_of("shot/a.####.exr", 7), "shot/a.0007.exr");
  EXPECT_EQ(file_of("##.png", 7), "07.png");
  EXPECT_EQ(file_of("a.#.exr", 7), "a.0007.exr");  // oiiotool
  EXPECT_EQ(file_of("50%-{}-%03d.exr", 0), "50%-{}-000.exr");
}

TEST(FramePatternOf, HasExactlyOneNumber) {
  const auto error_of = [](const char* text) {
    return input_error_of([&] { FramePattern(text, {"test"}); });
  };
  EXPECT_EQ(error_of("a.exr"),
            "test: \"a.exr\" has no places for the frame number; accepted with --frames: one, "
            "written %d, %04d or ####");
  EXPECT_EQ(error_of("%d-####.exr"),
            "test: \"%d-####.exr\" has 2 places for the frame number; accepted with --frames: one, "
            "written %d, %04d or ####");
  EXPECT_TRUE(has_frame_number("a-%02d.exr"));
  for (const char* text : {"a.exr", "%s.exr", "%4d.exr", "100%", "%0999999999999d.exr", "%"}) {
    EXPECT_FALSE(has_frame_number(text)) << text;
  }
}

TEST(Frames, AreRangesWithAStep) {
  EXPECT_EQ(parse_frames("0..3", {}), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(parse_frames("8-10", {}), (std::vector<int>{8, 9, 10}));
  EXPECT_EQ(parse_frames("1..6x2", {}), (std::vector<int>{1, 3, 5}));
  EXPECT_EQ(parse_frames("5", {}), std::vector<int>{5});
}

TEST(Frames, OfOtherFormsAreRefused) {
  for (const char* text : {"", "a", "3..1", "-1..3", "0...3", "0..3x0", "0..3x", "0..3,5", "0..",
                           "99999999999..3", "0.5..3"}) {
    EXPECT_EQ(input_error_of([&] { parse_frames(text, {"--frames"}); }),
              "--frames: \"" + std::string(text) +
                  "\" are no frames; accepted: FIRST..LAST such as 0..59, 0..58x2 for every second "
                  "one");
  }
  EXPECT_EQ(input_error_of([] { parse_frames("0..2147483647", {"--frames"}); }),
            "--frames: \"0..2147483647\" are 2147483648 frames; accepted: at most 100000");
}

}  // namespace
}  // namespace tests
