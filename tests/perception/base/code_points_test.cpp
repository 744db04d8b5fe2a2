#include "perception/base/code_points.h"

#include <vector>

#include <gtest/gtest.h>

namespace base {
namespace {

/// Code points of a text; 0xfffd for every byte that belongs to none.
std::vector<char32_t> code_points_of(std::string_view text) {
  std::vector<char32_t> points;
  while (!text.empty()) {
    const FirstCharacter first = first_character(text);
    points.push_back(first.code_point.value_or(0xfffd));
    text.remove_prefix(first.bytes);
  }
  return points;
}

using Points = std::vector<char32_t>;

TEST(CodePoints, OfOneToFourBytes) {
  EXPECT_EQ(code_points_of("A\u00e9\u5834\U0001f600"), (Points{'A', 0xe9, 0x5834, 0x1f600}));
  // The bounds of each length.
  EXPECT_EQ(code_points_of("\x7f\xc2\x80\xdf\xbf\xe0\xa0\x80\xef\xbf\xbf"),
            (Points{0x7f, 0x80, 0x7ff, 0x800, 0xffff}));
  EXPECT_EQ(code_points_of("\xf0\x90\x80\x80\xf4\x8f\xbf\xbf"), (Points{0x10000, 0x10ffff}));
}

/// Kuhn's stress test, sections 3 and 4: each byte stands for itself.
TEST(CodePoints, OfBytesThatAreNoCharactersAreNone) {
  const Points two{0xfffd, 0xfffd};
  const Points three{0xfffd, 0xfffd, 0xfffd};
  const Points four{0xfffd, 0xfffd, 0xfffd, 0xfffd};
  EXPECT_EQ(code_points_of("\x80\xbf"), two);           // continuations of nothing
  EXPECT_EQ(code_points_of("\xc0\xaf"), two);           // an overlong "/"
  EXPECT_EQ(code_points_of("\xc1\xbf"), two);           // an overlong U+007F
  EXPECT_EQ(code_points_of("\xe0\x9f\xbf"), three);     // an overlong U+07FF
  EXPECT_EQ(code_points_of("\xf0\x8f\xbf\xbf"), four);  // an overlong U+FFFF
  EXPECT_EQ(code_points_of("\xed\xa0\x80"), three);     // a surrogate
  EXPECT_EQ(code_points_of("\xf4\x90\x80\x80"), four);  // U+110000
  EXPECT_EQ(code_points_of("\xfe\xff"), two);
  EXPECT_EQ(code_points_of("\xe2\x82"
                           "A"),
            (Points{0xfffd, 0xfffd, 'A'}));
}

TEST(CodePoints, ACutCharacterIsToldFromABrokenOne) {
  for (const char* text : {"\xc2", "\xe2", "\xe2\x80", "\xf0", "\xf0\x9f\x98"}) {
    EXPECT_TRUE(first_character(text).is_cut);
    EXPECT_EQ(first_character(text).bytes, 1U);
  }
  for (const char* text : {"a", "\x9b",
                           "\xc2"
                           "a",
                           "\xe0\x80", "\xe2\x80\xae"}) {
    EXPECT_FALSE(first_character(text).is_cut);
  }
}

TEST(CodePoints, ControlsOfDirectionAreThoseOfTheProperty) {
  std::vector<char32_t> controls;
  for (char32_t point = 0; point < 0x3000; ++point) {
    if (is_direction_control(point)) controls.push_back(point);
  }
  EXPECT_EQ(controls, (Points{0x61c, 0x200e, 0x200f, 0x202a, 0x202b, 0x202c, 0x202d, 0x202e, 0x2066,
                              0x2067, 0x2068, 0x2069}));
}

TEST(CodePoints, DirectionsAreSpelledAndTheRestIsKept) {
  EXPECT_EQ(with_spelled_directions("box\u202egpj.\u2069 \u05d0\u00e9\x9b\xe2\x80"),
            "box\\u202egpj.\\u2069 \u05d0\u00e9\x9b\xe2\x80");
}

}  // namespace
}  // namespace base
