#include "results/html_report/html_table.h"

#include <fmt/format.h>

#include "results/html_report/html_text.h"

namespace results::html_report {

namespace {

std::string head_of(const Table& table) {
  std::string head;
  for (const TableColumn& column : table.columns) {
    head += fmt::format("<th{}>{}{}<small>{}</small></th>", column.is_number ? " class=\"n\"" : "",
                        escape(column.title), arrow_of(column.better), escape(column.unit));
  }
  return head;
}

std::string cell_html(const TableCell& cell, const TableColumn& column) {
  std::string css = column.is_number ? "n" : "";
  if (cell.shade) css += fmt::format("{}rank-{}", css.empty() ? "" : " ", *cell.shade);
  const std::string sort_value = cell.sort_value ? sort_attribute(*cell.sort_value) : "";
  const std::string note =
      cell.note.empty() ? "" : fmt::format("<small>{}</small>", escape(cell.note));
  return fmt::format("<td{}{}>{}{}</td>", css.empty() ? "" : fmt::format(" class=\"{}\"", css),
                     sort_value, escape(cell.text), note);
}

}  // namespace

const char* arrow_of(Direction better) {
  switch (better) {
    case Direction::lower:
      return " <span class=\"better\" title=\"lower is better\">↓</span>";
    case Direction::higher:
      return " <span class=\"better\" title=\"higher is better\">↑</span>";
    case Direction::none:
      return "";
  }
  return "";
}

std::string html_table(const Table& table, const std::string& id) {
  std::string body;
  for (const auto& row : table.rows) {
    body += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) body += cell_html(row[i], table.columns[i]);
    body += "</tr>\n";
  }
  std::string html = fmt::format(
      "<div class=\"scroll\"><table id=\"{}\" class=\"sortable numbers\"><thead><tr>{}"
      "</tr></thead><tbody>\n{}</tbody></table></div>\n",
      escape(id), head_of(table), body);
  for (const std::string& note : table.notes) {
    html += fmt::format("<p class=\"note\">{}</p>\n", escape(note));
  }
  return html;
}

}  // namespace results::html_report
