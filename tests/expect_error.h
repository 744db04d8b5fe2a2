#pragma once

#include <string>

#include <gtest/gtest.h>

namespace tests {

/// Expects `action` to throw `Error` with exactly this message.
template <class Error, class Action>
void expect_error(Action&& action, const std::string& message) {
  try {
    action();
    FAIL() << "nothing was thrown; expected: " << message;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), message);
  }
}

/// Expects `action` to throw `Error` with a message that holds every one of the pieces.
template <class Error, class Action>
void expect_error_with(Action&& action, std::initializer_list<std::string> pieces) {
  try {
    action();
    FAIL() << "nothing was thrown; expected: " << *pieces.begin();
  } catch (const Error& error) {
    for (const std::string& piece : pieces) {
      EXPECT_NE(std::string(error.what()).find(piece), std::string::npos)
          << "message: " << error.what() << "\nlacks: " << piece;
    }
  }
}

}  // namespace tests
