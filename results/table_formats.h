#pragma once

#include <array>
#include <string>

#include "results/tables.h"

/// Tables as other programs read them.
namespace results {

/// Marks the best number of every column that has a better direction, within the rows of one scene
/// (those with one text in the first column), if its 95 % interval lies apart from those of all
/// other rows there. A number without an interval, of one seed or repetition, is never called best
/// and leaves no other one best either.
void mark_best(Table& table);

/// GitHub's Markdown; what is best is bold.
std::string to_markdown(const Table& table);

/// As csv_table.h, without notes; a number with an interval has two more columns, "low" and "high",
/// and all digits. Values that are not there are empty.
std::string to_csv(const Table& table);

/// A `tabular` of the LaTeX package booktabs; what is best is bold, notes are comments.
std::string to_latex(const Table& table);

/// Those that can be asked for by name.
inline constexpr std::array kTableFormats{"text", "markdown", "csv", "latex"};
/// @param format  one of kTableFormats
std::string to_format(const Table& table, const std::string& format);

}  // namespace results
