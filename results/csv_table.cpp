#include "results/csv_table.h"

#include <cassert>
#include <cmath>

#include <fmt/format.h>

namespace results {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += c;
    result += c;
  }
  return result + "\"";
}

std::string number_text(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{}", *value) : "";
}

std::string cell_text(const CsvTable::Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return quoted(*text);
  if (const auto* number = std::get_if<double>(&cell)) return number_text(*number);
  return number_text(std::get<std::optional<double>>(cell));
}

}  // namespace

std::string to_csv(const CsvTable& table) {
  std::string csv;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    csv += (i == 0 ? "" : ",") + quoted(table.columns[i]);
  }
  csv += '\n';
  for (const auto& row : table.rows) {
    assert(row.size() == table.columns.size());
    for (std::size_t i = 0; i < row.size(); ++i) csv += (i == 0 ? "" : ",") + cell_text(row[i]);
    csv += '\n';
  }
  return csv;
}

}  // namespace results
