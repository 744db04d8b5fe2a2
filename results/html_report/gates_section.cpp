#include "results/html_report/gates_section.h"

#include <algorithm>

#include <fmt/format.h>

#include "results/html_report/chip.h"
#include "results/html_report/html_text.h"

namespace results::html_report {

namespace {

using gates::Outcome;

ChipLook look_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return kGoodLook;
    case Outcome::failed:
      return kBadLook;
    case Outcome::inconclusive:
      return kOpenLook;
    case Outcome::not_measured:
      break;
  }
  return kApartLook;
}

std::string words_of(Outcome outcome) {
  std::string words = to_string(outcome);
  std::ranges::replace(words, '_', ' ');
  return words;
}

/// The column that says how a number changed; of a gate the outcome says more.
constexpr const char* kVerdictTitle = "verdict";

std::string head_of(const Table& table) {
  std::string head = "<th>outcome</th>";
  for (const TableColumn& column : table.columns) {
    if (column.title != kVerdictTitle) head += fmt::format("<th>{}</th>", escape(column.title));
  }
  return head;
}

std::string row_of(const Table& table, std::size_t row, Outcome outcome) {
  std::string html = "<tr><td>" + outcome_chip(outcome, words_of(outcome)) + "</td>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].title == kVerdictTitle) continue;
    html += fmt::format("<td>{}</td>", escape(table.rows[row][i].text));
  }
  return html + "</tr>\n";
}

}  // namespace

std::string outcome_chip(Outcome outcome, const std::string& text) {
  return chip(look_of(outcome), text);
}

std::string gates_section(const gates::GateReport& report) {
  if (report.gates.empty()) return "";
  std::string html = "<section id=\"gates\"><h2>Gates</h2>\n<p>";
  for (const Outcome outcome :
       {Outcome::failed, Outcome::inconclusive, Outcome::not_measured, Outcome::passed}) {
    const std::size_t count = report.count(outcome);
    if (count == 0) continue;
    html += outcome_chip(outcome, fmt::format("{} {}", words_of(outcome), count)) + " ";
  }
  html += "</p>\n";
  const Table table = gate_table(report, true);
  if (!table.rows.empty()) {
    html += "<div class=\"scroll\"><table class=\"words sortable\"><thead><tr>" + head_of(table) +
            "</tr></thead><tbody>\n";
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      html += row_of(table, i, gates::outcome_of(report.entries[i].change));
    }
    html += "</tbody></table></div>\n";
  }
  for (const std::string& note : table.notes) {
    html += fmt::format("<p class=\"note\">{}</p>\n", escape(note));
  }
  return html + "</section>\n";
}

}  // namespace results::html_report
