#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace suites::command_line {

/// Where a verb writes: data to `out`, progress and messages to `err`.
struct Console {
  std::ostream& out;
  std::ostream& err;
  bool err_is_terminal = false;
  bool err_has_color = false;  ///< a terminal, and NO_COLOR is not set
  int err_columns = 80;
};

/// The process's own streams. https://no-color.org: NO_COLOR set and not empty means no colour.
Console process_console();

/// One JSON object, indented, with a line feed; non-finite numbers become null.
void print_json(Console& console, const nlohmann::ordered_json& json);

/// "discern: note: ..." on err.
void print_note(Console& console, std::string_view text);

/// "discern: error: ..." on err, in red where there is colour.
void print_error(Console& console, std::string_view text);

/// Rows in columns as wide as their widest cell, two spaces between them, each row on a line. The
/// first row is the header. Cells that look like numbers are right-aligned.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace suites::command_line
