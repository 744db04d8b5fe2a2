#include "results/table_formats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/csv_table.h"

namespace results {

namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

/// Replaces, from left to right, the first entry that matches.
template <std::size_t N>
std::string replaced(std::string_view text, const std::array<Replacement, N>& replacements) {
  std::string result;
  while (!text.empty()) {
    const auto found = std::ranges::find_if(
        replacements, [&](const Replacement& entry) { return text.starts_with(entry.first); });
    if (found == replacements.end()) {
      result += text.front();
      text.remove_prefix(1);
    } else {
      result += found->second;
      text.remove_prefix(found->first.size());
    }
  }
  return result;
}

std::string markdown(std::string_view text) {
  return replaced(
      text,
      std::array<Replacement, 6>{
          {{"|", "\\|"}, {"\n", " "}, {"*", "\\*"}, {"_", "\\_"}, {"<", "&lt;"}, {"[", "\\["}}});
}

std::string latex(std::string_view text) {
  return replaced(text, std::array<Replacement, 17>{{{"\\", R"(\textbackslash{})"},
                                                     {"&", R"(\&)"},
                                                     {"%", R"(\%)"},
                                                     {"$", R"(\$)"},
                                                     {"#", R"(\#)"},
                                                     {"_", R"(\_)"},
                                                     {"{", R"(\{)"},
                                                     {"}", R"(\})"},
                                                     {"~", R"($\sim$)"},
                                                     {"^", R"(\^{})"},
                                                     {"<", "$<$"},
                                                     {">", "$>$"},
                                                     {"±", R"($\pm$)"},
                                                     {"∞", R"($\infty$)"},
                                                     {"↓", R"($\downarrow$)"},
                                                     {"↑", R"($\uparrow$)"},
                                                     {"\n", " "}}});
}

std::string with_arrow(const TableColumn& column) {
  const char* arrow = column.better == Direction::lower    ? " ↓"
                      : column.better == Direction::higher ? " ↑"
                                                           : "";
  return column.title + arrow;
}

std::string with_note(const TableCell& cell) {
  return cell.note.empty() ? cell.text : fmt::format("{} ({})", cell.text, cell.note);
}

bool has_interval(const Estimate& estimate) { return estimate.count > 1; }

/// Rows [begin, end) of one scene.
void mark_best_of(Table& table, std::size_t column, std::size_t begin, std::size_t end) {
  const bool is_lower = table.columns[column].better == Direction::lower;
  const auto is_ahead = [is_lower](double a, double b) { return is_lower ? a < b : a > b; };
  std::size_t best = end;
  for (std::size_t i = begin; i < end; ++i) {
    const auto& estimate = table.rows[i][column].estimate;
    if (!estimate) continue;
    if (best == end || is_ahead(estimate->value, table.rows[best][column].estimate->value))
      best = i;
  }
  if (best == end || !has_interval(*table.rows[best][column].estimate)) return;
  const Estimate& winner = *table.rows[best][column].estimate;
  std::size_t rivals = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const auto& other = table.rows[i][column].estimate;
    if (i == best || !other) continue;
    ++rivals;
    const bool is_apart = is_lower ? winner.high < other->low : winner.low > other->high;
    if (!has_interval(*other) || !is_apart) return;
  }
  table.rows[best][column].is_best = rivals > 0;
}

bool has_estimates(const Table& table, std::size_t column) {
  return std::ranges::any_of(table.rows,
                             [&](const auto& row) { return row[column].estimate.has_value(); });
}

}  // namespace

void mark_best(Table& table) {
  for (std::size_t begin = 0; begin < table.rows.size();) {
    std::size_t end = begin;
    while (end < table.rows.size() && table.rows[end][0].text == table.rows[begin][0].text) ++end;
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      if (table.columns[column].better != Direction::none) mark_best_of(table, column, begin, end);
    }
    begin = end;
  }
}

std::string to_markdown(const Table& table) {
  std::string text = "|";
  std::string rule = "|";
  for (const TableColumn& column : table.columns) {
    const std::string unit = column.unit.empty() ? "" : fmt::format(" [{}]", column.unit);
    text += fmt::format(" {} |", markdown(with_arrow(column) + unit));
    rule += column.is_number ? " ---: |" : " --- |";
  }
  text += "\n" + rule + "\n";
  for (const auto& row : table.rows) {
    text += "|";
    for (const TableCell& cell : row) {
      const std::string word = markdown(with_note(cell));
      text += cell.is_best ? fmt::format(" **{}** |", word) : fmt::format(" {} |", word);
    }
    text += "\n";
  }
  for (const std::string& note : table.notes) text += "\n" + markdown(note) + "\n";
  return text;
}

std::string to_csv(const Table& table) {
  CsvTable csv;
  std::vector<bool> is_estimated;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    csv.columns.push_back(column.unit.empty() ? column.title
                                              : fmt::format("{} [{}]", column.title, column.unit));
    is_estimated.push_back(has_estimates(table, i));
    if (!is_estimated.back()) continue;
    csv.columns.push_back(column.title + " low");
    csv.columns.push_back(column.title + " high");
  }
  for (const auto& row : table.rows) {
    std::vector<CsvTable::Cell>& cells = csv.rows.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!is_estimated[i]) {
        cells.emplace_back(with_note(row[i]));
        continue;
      }
      std::optional<double> bounds[3];
      if (const auto& estimate = row[i].estimate) {
        bounds[0] = estimate->value;
        if (has_interval(*estimate)) bounds[1] = estimate->low;
        if (has_interval(*estimate)) bounds[2] = estimate->high;
      }
      for (const std::optional<double>& bound : bounds) cells.emplace_back(bound);
    }
  }
  return to_csv(csv);
}

std::string to_latex(const Table& table) {
  std::string alignment;
  std::vector<std::string> titles;
  std::vector<std::string> units;
  for (const TableColumn& column : table.columns) {
    alignment += column.is_number ? 'r' : 'l';
    titles.push_back(latex(with_arrow(column)));
    units.push_back(latex(column.unit));
  }
  std::string text = fmt::format(
      "% needs \\usepackage{{booktabs}}\n\\begin{{tabular}}{{{}}}\n\\toprule\n{} \\\\\n{} \\\\\n"
      "\\midrule\n",
      alignment, fmt::join(titles, " & "), fmt::join(units, " & "));
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const TableCell& cell : row) {
      const std::string word = latex(with_note(cell));
      cells.push_back(cell.is_best ? fmt::format("\\textbf{{{}}}", word) : word);
    }
    text += fmt::format("{} \\\\\n", fmt::join(cells, " & "));
  }
  text += "\\bottomrule\n\\end{tabular}\n";
  for (const std::string& note : table.notes) text += fmt::format("% {}\n", note);
  return text;
}

std::string to_format(const Table& table, const std::string& format) {
  if (format == "markdown") return to_markdown(table);
  if (format == "csv") return to_csv(table);
  if (format == "latex") return to_latex(table);
  return to_text(table);
}

}  // namespace results
