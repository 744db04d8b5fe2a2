#include "suites/command_line/progress_display.h"

#include <gtest/gtest.h>

#include <sstream>

namespace suites::command_line {
namespace {

Progress at(double elapsed_s, std::size_t done, const std::string& activity = "horse pt8") {
  return {activity, done, 4, elapsed_s, 3.0};
}

class ProgressDisplayTest : public testing::Test {
 protected:
  std::ostringstream out;
  std::ostringstream err;
  Console console{out, err};
};

TEST_F(ProgressDisplayTest, WritesPlainLinesAtMostOneASecond) {
  {
    ProgressDisplay display(console);
    display.show(at(0.0, 0));
    display.show(at(0.5, 1));  // too soon
    display.show(at(1.5, 2));
    display.show(at(1.6, 4));  // the last one always shows
  }
  EXPECT_EQ(err.str(),
            "[0/4] horse pt8 (0 s, 3.00 s left)\n"
            "[2/4] horse pt8 (1.50 s, 3.00 s left)\n"
            "[4/4] horse pt8 (1.60 s, 3.00 s left)\n");
  EXPECT_EQ(out.str(), "");
}

TEST_F(ProgressDisplayTest, GivesASignOfLifeWhenNothingIsFinished) {
  ProgressDisplay display(console);
  display.show(at(0.0, 1));
  display.show(at(5.0, 1));
  display.show(at(10.0, 1));
  EXPECT_EQ(err.str(),
            "[1/4] horse pt8 (0 s, 3.00 s left)\n[1/4] horse pt8 (10.0 s, 3.00 s left)\n");
}

TEST_F(ProgressDisplayTest, RenewsOneLineOnATerminalAndRemovesIt) {
  console.err_is_terminal = true;
  {
    ProgressDisplay display(console);
    display.show(at(1.0, 1));
  }
  EXPECT_EQ(err.str(), "\r\x1b[K" + progress_bar(at(1.0, 1), 80) + "\r\x1b[K");
}

TEST_F(ProgressDisplayTest, TheBarShowsThePartDoneAndFitsTheTerminal) {
  const std::string bar = progress_bar(at(1.0, 1), 120);
  EXPECT_EQ(bar, "[######------------------]  1/4  1.00 s, 3.00 s left  horse pt8");
  EXPECT_EQ(progress_bar(at(1.0, 1), 30).size(), 29U);
  EXPECT_EQ(progress_line({"x", 1, 2, 1.0, -1.0}), "[1/2] x (1.00 s)");
}

}  // namespace
}  // namespace suites::command_line
