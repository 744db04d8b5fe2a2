#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace suites::command_line {

/// Text that no terminal takes as a command, whoever wrote it, and that reads as it is written:
/// control characters but tab and line feed, and those that change the direction of text, are
/// spelled as JSON has them ("\u001b", "\u202e"), bytes that are no UTF-8 by their values ("\x9b"),
/// all else stays as it is.
std::string printable(std::string_view text);

/// Passes on what is written to it as `printable` has it.
class PrintableBuffer : public std::streambuf {
 public:
  /// @param target  outlives this buffer
  explicit PrintableBuffer(std::ostream& target) : target_(target) {}
  ~PrintableBuffer() override;

 private:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int sync() override;
  bool pass(std::string_view text);

  std::ostream& target_;
  std::string pending_;  ///< the last bytes, if they begin a character that is not complete
};

}  // namespace suites::command_line
