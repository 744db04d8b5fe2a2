#pragma once

#include <string>

namespace results::html_report {

/// A class of the style sheet and a sign: verdicts are told apart without colour, too.
struct ChipLook {
  const char* css;
  const char* sign;
};
inline constexpr ChipLook kGoodLook{"reproduced", "✓"};
inline constexpr ChipLook kBadLook{"not-reproduced", "✗"};
inline constexpr ChipLook kOpenLook{"inconclusive", "?"};
inline constexpr ChipLook kApartLook{"not-comparable", "–"};
inline constexpr ChipLook kPlainLook{"printed", "·"};

/// A few words of judgement with their sign; the words are escaped.
std::string chip(const ChipLook& look, const std::string& text);

}  // namespace results::html_report
