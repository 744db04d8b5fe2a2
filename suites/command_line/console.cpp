#include "suites/command_line/console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "suites/command_line/printable_text.h"

namespace suites::command_line {

namespace {

constexpr int kIndent = 2;

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// True for "12", "-0.5", "1.2e-3", "64x64", "12 %", "1.2 ms": a digit first, after a sign.
bool looks_like_number(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0;
}

/// Characters of UTF-8 text: bytes that do not continue one.
std::size_t display_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

Console process_console() {
  Console console{std::cout, std::cerr};
  const char* terminal = std::getenv("TERM");
  const bool is_dumb = terminal != nullptr && std::string_view(terminal) == "dumb";
  console.err_is_terminal = isatty(STDERR_FILENO) == 1 && !is_dumb;
  console.err_has_color = console.err_is_terminal && !is_set("NO_COLOR");
  winsize size{};
  if (console.err_is_terminal && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    console.err_columns = size.ws_col;
  }
  return console;
}

void print_json(Console& console, const nlohmann::ordered_json& json) {
  console.out << json.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

void print_note(Console& console, std::string_view text) {
  console.err << "discern: note: " << printable(text) << '\n';
}

void print_error(Console& console, std::string_view text) {
  const char* red = console.err_has_color ? "\x1b[31m" : "";
  const char* plain = console.err_has_color ? "\x1b[0m" : "";
  console.err << "discern: " << red << "error:" << plain << ' ' << printable(text) << '\n';
}

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], display_width(row[i]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - display_width(row[i]), ' ');
      if (i > 0) line += "  ";
      line += looks_like_number(row[i]) ? padding + row[i] : row[i] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

}  // namespace suites::command_line
