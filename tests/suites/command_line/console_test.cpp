#include "suites/command_line/console.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/printable_text.h"
#include "suites/command_line/rectangle.h"

namespace suites::command_line {
namespace {

TEST(TextTable, AlignsWordsLeftAndNumbersRight) {
  EXPECT_EQ(text_table({{"name", "faces", "note"}, {"box", "32", "a"}, {"bunny", "69666", ""}}),
            "name   faces  note\n"
            "box       32  a\n"
            "bunny  69666\n");
}

TEST(TextTable, CountsCharactersNotBytes) {
  EXPECT_EQ(text_table({{"a", "b"}, {"±", "x"}}), "a  b\n±  x\n");
}

TEST(PrintJson, WritesNonFiniteNumbersAsNull) {
  std::ostringstream out;
  std::ostringstream err;
  Console console{out, err};
  print_json(console, {{"value", std::numeric_limits<double>::infinity()}});
  EXPECT_EQ(out.str(), "{\n  \"value\": null\n}\n");
}

TEST(Printable, SpellsControlCharactersAndKeepsTheRest) {
  EXPECT_EQ(printable("a\tb\nµ \u00e9 \u2026"), "a\tb\nµ \u00e9 \u2026");
  EXPECT_EQ(printable("\x1b[31m\r\x7f\u009b\xc2"), "\\u001b[31m\\u000d\\u007f\\u009b\\xc2");
}

TEST(Printable, SpellsWhatTurnsTheDirectionOfText) {
  EXPECT_EQ(printable("a\u202egpj\u202c \u2066b\u2069 \u200e\u200f\u061c"),
            "a\\u202egpj\\u202c \\u2066b\\u2069 \\u200e\\u200f\\u061c");
  EXPECT_EQ(printable("\u05d0\u05d1 \u2018q\u2019 \u2065"), "\u05d0\u05d1 \u2018q\u2019 \u2065");
}

/// A terminal of eight bits takes a lone 0x9b as the beginning of a command, whatever follows.
TEST(Printable, SpellsBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("a\x9b"
                      "31m"),
            "a\\x9b31m");
  EXPECT_EQ(printable("\x80\x9f\xa0\xff\xc0\x9b"), "\\x80\\x9f\\xa0\\xff\\xc0\\x9b");
  EXPECT_EQ(printable("\xe2\x9b"
                      "1"),
            "\\xe2\\x9b1");
  EXPECT_EQ(printable("\xe9 t\xe9"), "\\xe9 t\\xe9");
  // As the second byte of a character it is none.
  EXPECT_EQ(printable("\u015b"), "\u015b");
}

TEST(Printable, ABufferMayGetACharacterInTwoParts) {
  std::ostringstream target;
  {
    PrintableBuffer buffer(target);
    std::ostream out(&buffer);
    out << "a\xc2" << '\x9b' << "b\xc2"
        << "\xb5 \xe2\x80";
    out.flush();
    out << "\xae\xe2" << '\x80' << "\xa6\xf0\x9f\x98"
        << "\x80\xe2\x80";
  }
  EXPECT_EQ(target.str(), "a\\u009bb\u00b5 \\u202e\u2026\U0001f600\\xe2\\x80");
}

TEST(PrintError, IsRedOnlyWhereThereIsColour) {
  std::ostringstream out;
  std::ostringstream err;
  Console console{out, err};
  print_error(console, "no");
  console.err_has_color = true;
  print_error(console, "no");
  EXPECT_EQ(err.str(), "discern: error: no\ndiscern: \x1b[31merror:\x1b[0m no\n");
}

TEST(ExitCodes, TheMostImportantOneCounts) {
  EXPECT_EQ(most_important({}), 0);
  EXPECT_EQ(most_important({0, 5}), 5);
  EXPECT_EQ(most_important({5, 1}), 1);
  EXPECT_EQ(most_important({1, 3}), 3);
  EXPECT_EQ(most_important({3, 4}), 4);
  EXPECT_EQ(most_important({4, 2}), 2);
  EXPECT_EQ(most_important({2, 130}), 130);
}

TEST(QuotedCommand, CanBeGivenToAShellAgain) {
  EXPECT_EQ(quoted_command({"run", "--method", "path,samples=8"}),
            "discern run --method path,samples=8");
  EXPECT_EQ(quoted_command({"--filter", "a|b c", "it's", ""}),
            "discern --filter 'a|b c' 'it'\\''s' ''");
}

std::string refusal(const std::string& text) {
  try {
    parse_rectangle(text, {64, 32}, {"--region"});
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Rectangle, LiesWithinTheImage) {
  const RectanglePx whole = parse_rectangle("0,0,64,32", {64, 32}, {"--region"});
  EXPECT_EQ(whole.width, 64);
  EXPECT_EQ(whole.height, 32);
  EXPECT_EQ(refusal("1,0,64,32"),
            "--region: the rectangle 1,0,64,32 is empty or leaves the image of 64x32 pixels");
  EXPECT_EQ(refusal("0,0,0,32"),
            "--region: the rectangle 0,0,0,32 is empty or leaves the image of 64x32 pixels");
  for (const std::string text : {"1,2,3", "1,2,3,4,5", "1,2,3,x", "", "1,2,3,4.5", "1,2,,4"}) {
    EXPECT_EQ(refusal(text), "--region: \"" + text +
                                 "\" is not x,y,width,height in whole pixels from the top left");
  }
}

TEST(Rectangle, SurvivesNumbersThatOverflow) {
  EXPECT_NE(refusal("2147483647,0,2147483647,1"), "accepted");
  EXPECT_NE(refusal("99999999999,0,1,1"), "accepted");
}

}  // namespace
}  // namespace suites::command_line
