#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace base {

/// The beginning of a text of UTF-8.
struct FirstCharacter {
  std::size_t bytes = 0;               ///< that it takes; 1 for a byte of no character
  std::optional<char32_t> code_point;  ///< nothing: the first byte belongs to no character
  bool is_cut = false;                 ///< all there is begins a character that more may complete
};

/// The first character as the Unicode standard has it (version 15, table 3-7): overlong forms,
/// surrogates and what lies beyond U+10FFFF are none.
/// @param text  not empty
FirstCharacter first_character(std::string_view text);

/// True for what changes the direction of text without being seen: a name with it can be shown as
/// another one (Unicode Technical Report 36, Sec. 2.8; the property Bidi_Control).
bool is_direction_control(char32_t code_point);

/// A character as JSON spells it, "\u202e"; below U+10000 only.
std::string spelled(char32_t code_point);

/// Controls of direction spelled out, all else as it is.
std::string with_spelled_directions(std::string_view text);

}  // namespace base
