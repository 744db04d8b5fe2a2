#include "suites/command_line/printable_text.h"

#include <fmt/format.h>

#include "perception/base/code_points.h"

namespace suites::command_line {

namespace {

/// The two sets of ECMA-48 and DEL, but for tab and line feed.
bool is_control(char32_t point) {
  if (point == U'\t' || point == U'\n') return false;
  return point < 0x20 || (point >= 0x7f && point <= 0x9f);
}

std::string spelled_byte(char c) { return fmt::format("\\x{:02x}", static_cast<unsigned char>(c)); }

/// @param pending  bytes before the text; what is left at its end for the next one
std::string printable_part(std::string_view text, std::string& pending) {
  const std::string joined = pending + std::string(text);
  pending.clear();
  std::string result;
  result.reserve(joined.size());
  for (std::string_view rest = joined; !rest.empty();) {
    const base::FirstCharacter first = base::first_character(rest);
    if (first.is_cut) {
      pending = rest;
      break;
    }
    if (!first.code_point) {
      result += spelled_byte(rest.front());
    } else if (is_control(*first.code_point) || base::is_direction_control(*first.code_point)) {
      result += base::spelled(*first.code_point);
    } else {
      result += rest.substr(0, first.bytes);
    }
    rest.remove_prefix(first.bytes);
  }
  return result;
}

/// What never became a character.
std::string spelled_bytes(std::string_view pending) {
  std::string result;
  for (const char c : pending) result += spelled_byte(c);
  return result;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string pending;
  const std::string result = printable_part(text, pending);
  return result + spelled_bytes(pending);
}

PrintableBuffer::~PrintableBuffer() { target_ << spelled_bytes(pending_); }

bool PrintableBuffer::pass(std::string_view text) {
  target_ << printable_part(text, pending_);
  return target_.good();
}

PrintableBuffer::int_type PrintableBuffer::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char text = traits_type::to_char_type(c);
  return pass({&text, 1}) ? c : traits_type::eof();
}

std::streamsize PrintableBuffer::xsputn(const char* text, std::streamsize size) {
  return pass({text, static_cast<std::size_t>(size)}) ? size : 0;
}

int PrintableBuffer::sync() { return target_.flush().good() ? 0 : -1; }

}  // namespace suites::command_line
