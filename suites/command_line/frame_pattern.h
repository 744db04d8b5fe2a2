#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "perception/base/errors.h"

namespace suites::command_line {

/// The files of a sequence, one per frame number: "shot.%04d.exr" as printf and ffmpeg write it, or
/// "shot.####.exr" with a # per digit (a single # is four digits, as in oiiotool).
class FramePattern {
 public:
  /// @throws base::InputError unless the text has exactly one place for the number
  FramePattern(std::string_view text, const base::Place& place);

  const std::string& text() const { return text_; }
  std::string file(int frame) const;

 private:
  std::string text_;
  std::string before_;
  std::string after_;
  int digits_ = 0;  ///< at least so many, filled up with zeros
};

/// True if the text has a place for a frame number.
bool has_frame_number(std::string_view text);

/// Reads "FIRST..LAST" or "FIRST-LAST", with "xSTEP" behind it every STEP-th frame, or one number.
/// @return at least one number, none below 0, increasing
/// @throws base::InputError with the accepted forms
std::vector<int> parse_frames(std::string_view text, const base::Place& place);

}  // namespace suites::command_line
