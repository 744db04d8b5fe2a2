#include "perception/base/code_points.h"

#include <fmt/format.h>

namespace base {

namespace {

/// What may follow a first byte: how many bytes, and between which bounds the next one lies.
struct Form {
  std::size_t bytes = 0;  ///< of the whole character; 0: no character begins so
  unsigned char low = 0x80;
  unsigned char high = 0xbf;
};

/// The Unicode standard, version 15, table 3-7.
Form form_of(unsigned char first) {
  if (first < 0x80) return {1};
  if (first < 0xc2) return {0};
  if (first < 0xe0) return {2};
  if (first == 0xe0) return {3, 0xa0};
  if (first == 0xed) return {3, 0x80, 0x9f};
  if (first < 0xf0) return {3};
  if (first == 0xf0) return {4, 0x90};
  if (first < 0xf4) return {4};
  if (first == 0xf4) return {4, 0x80, 0x8f};
  return {0};
}

}  // namespace

FirstCharacter first_character(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const Form form = form_of(first);
  if (form.bytes == 0) return {1, std::nullopt, false};
  if (form.bytes == 1) return {1, first, false};
  char32_t point = first & (0x7fU >> form.bytes);
  for (std::size_t i = 1; i < form.bytes; ++i) {
    if (i == text.size()) return {1, std::nullopt, true};
    const auto next = static_cast<unsigned char>(text[i]);
    const unsigned char low = i == 1 ? form.low : 0x80;
    const unsigned char high = i == 1 ? form.high : 0xbf;
    if (next < low || next > high) return {1, std::nullopt, false};
    point = (point << 6U) | (next & 0x3fU);
  }
  return {form.bytes, point, false};
}

bool is_direction_control(char32_t code_point) {
  return code_point == 0x061c || code_point == 0x200e || code_point == 0x200f ||
         (code_point >= 0x202a && code_point <= 0x202e) ||
         (code_point >= 0x2066 && code_point <= 0x2069);
}

std::string spelled(char32_t code_point) {
  return fmt::format("\\u{:04x}", static_cast<unsigned>(code_point));
}

std::string with_spelled_directions(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const FirstCharacter first = first_character(text);
    if (first.code_point && is_direction_control(*first.code_point)) {
      result += spelled(*first.code_point);
    } else {
      result += text.substr(0, first.bytes);
    }
    text.remove_prefix(first.bytes);
  }
  return result;
}

}  // namespace base
