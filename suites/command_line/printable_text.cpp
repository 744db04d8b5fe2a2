#include "suites/command_line/printable_text.h"

#include <fmt/format.h>

namespace suites::command_line {

namespace {

/// First of the two bytes of U+0080 to U+00BF in UTF-8.
constexpr char kLead = '\xc2';

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20U && c != '\n' && c != '\t') || byte == 0x7fU;
}

/// True for the second byte of U+0080 to U+009F, the controls of ECMA-48's second set.
bool is_second_of_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80U && byte <= 0x9fU;
}

std::string spelled(char c) { return fmt::format("\\u{:04x}", static_cast<unsigned char>(c)); }

/// @param has_lead  a kLead was read and not yet written; left so for the next text
std::string printable_part(std::string_view text, bool& has_lead) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (has_lead) {
      has_lead = false;
      if (is_second_of_control(c)) {
        result += spelled(c);
        continue;
      }
      result += kLead;
    }
    if (c == kLead) {
      has_lead = true;
    } else if (is_control(c)) {
      result += spelled(c);
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text) {
  bool has_lead = false;
  std::string result = printable_part(text, has_lead);
  if (has_lead) result += kLead;
  return result;
}

PrintableBuffer::~PrintableBuffer() {
  if (has_lead_) target_.put(kLead);
}

bool PrintableBuffer::pass(std::string_view text) {
  target_ << printable_part(text, has_lead_);
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
