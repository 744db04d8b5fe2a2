#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace results {

/// Numbers for other programs: those that a figure shows, or a table.
struct CsvTable {
  using Cell = std::variant<std::string, double, std::optional<double>>;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< as many cells as columns
};

/// RFC 4180 with lines that end in \n; numbers in the fewest digits that give them back exactly,
/// what is absent or not finite as an empty field.
std::string to_csv(const CsvTable& table);

}  // namespace results
