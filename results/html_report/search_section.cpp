#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/html_report/html_table.h"
#include "results/html_report/sections.h"

namespace results::html_report {

namespace {

TableCell text_cell(const std::string& text) { return {text, std::nullopt, false, "", {}}; }

TableCell number_cell(const std::optional<double>& value) {
  if (!value) return text_cell("-");
  return {base::format_significant(*value, 4), *value, false, "", {}};
}

/// "16: 0.21, 38: 0.48": every render of a search.
std::string probes_text(const SearchRecord& search) {
  std::string text;
  for (const SearchRecord::Probe& probe : search.probes) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", fmt::format("{:.6g}", probe.setting),
                        base::format_significant(probe.measured, 3));
  }
  return text;
}

std::string outcome_text(const SearchRecord& search) {
  std::string words = search.outcome;
  for (char& c : words) {
    if (c == '_') c = ' ';
  }
  return search.reason.empty() ? words : words + ": " + search.reason;
}

}  // namespace

std::string search_section(const ReportData& data) {
  if (data.run.searches.empty()) return "";
  Table table;
  table.columns = {{"scene", "", Direction::none, false},   {"method", "", Direction::none, false},
                   {"budget", "", Direction::none, false},  {"of", "", Direction::none, false},
                   {"target", "", Direction::none, true},   {"achieved", "", Direction::none, true},
                   {"setting", "", Direction::none, false}, {"found", "", Direction::none, true},
                   {"renders", "", Direction::none, true},  {"outcome", "", Direction::none, false},
                   {"probes", "", Direction::none, false}};
  for (const SearchRecord& search : data.run.searches) {
    const auto renders = static_cast<double>(search.probes.size());
    table.rows.push_back(
        {text_cell(search.scene), text_cell(search.method), text_cell(search.budget),
         text_cell(search.quantity), number_cell(search.target), number_cell(search.achieved),
         text_cell(search.setting), number_cell(search.value), number_cell(renders),
         text_cell(outcome_text(search)), text_cell(probes_text(search))});
  }
  table.notes = {
      "Budgets by time and error: the setting was searched on this machine until the target was "
      "met "
      "within 5 % or nothing nearer was left. achieved: in the search; the tables above show what "
      "the cells then took and scored."};
  return "<section id=\"searches\"><h2>Searched budgets</h2>\n" +
         html_table(table, "search-table") + "</section>\n";
}

}  // namespace results::html_report
