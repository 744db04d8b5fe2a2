#include "results/figures/gnuplot_text.h"

#include <algorithm>

#include "perception/base/code_points.h"

namespace results::figures {

namespace {

constexpr std::string_view kEnhancedMarks = "\\^_{}@&~";

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// True for the bytes that do not begin a character of UTF-8.
bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

std::string escaped(std::string_view text, bool is_format) {
  std::string result;
  for (const char c : base::with_spelled_directions(text)) {
    if (kEnhancedMarks.find(c) != std::string_view::npos) result += '\\';
    if (c == '\'' || (c == '%' && is_format)) result += c;
    result += is_control(c) ? ' ' : c;
  }
  return result;
}

}  // namespace

std::string gnuplot_string(std::string_view text) { return "'" + escaped(text, false) + "'"; }

std::string gnuplot_plain_string(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += c;
    result += c;
  }
  return result + "'";
}

std::string gnuplot_tic_string(std::string_view text) { return "'" + escaped(text, true) + "'"; }

std::string gnuplot_bold_string(std::string_view text) {
  return "'{/:Bold " + escaped(text, false) + "}'";
}

std::string gnuplot_comment(std::string_view text) {
  std::string result = base::with_spelled_directions(text);
  std::replace_if(result.begin(), result.end(), is_control, ' ');
  if (!result.empty() && result.back() == '\\') result += '.';
  return result;
}

double text_width_cm(std::string_view text, double font_pt) {
  constexpr double kMeanAdvance_em = 0.58;  // of DejaVu Sans, measured over names as ours
  constexpr double kPoint_cm = 2.54 / 72.0;
  const auto characters =
      std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); });
  return kMeanAdvance_em * kPoint_cm * font_pt * static_cast<double>(characters);
}

std::string shortened(std::string_view text, double width_cm, double font_pt) {
  if (text_width_cm(text, font_pt) <= width_cm) return std::string(text);
  std::size_t end = text.size();
  while (end > 1 && text_width_cm(std::string(text.substr(0, end)) + "...", font_pt) > width_cm) {
    do {
      --end;
    } while (end > 1 && is_continuation(text[end]));
  }
  return std::string(text.substr(0, end)) + "...";
}

}  // namespace results::figures
