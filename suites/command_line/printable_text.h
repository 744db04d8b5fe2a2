#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace suites::command_line {

/// Text that no terminal of UTF-8 takes as a command, whoever wrote it: control characters but tab
/// and line feed are spelled as JSON has them ("\u001b"), all else stays as it is.
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
  bool has_lead_ = false;  ///< the last byte may begin a control character of two bytes
};

}  // namespace suites::command_line
