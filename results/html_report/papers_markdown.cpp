#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/html_report/json_text.h"
#include "results/html_report/papers_page.h"
#include "results/html_report/run_facts.h"
#include "results/table_formats.h"

namespace results::html_report {

namespace {

using claims::ClaimResult;
using claims::LedgerRow;
using claims::RowState;

/// Claims of a row that are told by their numbers; the rest is in the page.
constexpr std::size_t kMostClaims = 4;

TableCell words(std::string text) { return {std::move(text), std::nullopt, false, ""}; }

Table table_of(std::initializer_list<const char*> titles) {
  Table table;
  for (const char* title : titles) table.columns.push_back({title, "", Direction::none, false});
  return table;
}

std::string run_line(const Paper& paper) {
  const std::string profile = text_at(*paper.info, {"profile"});
  const std::string filter = text_at(*paper.info, {"filter"});
  return fmt::format("profile {}{}, run {}, commit {}, machine {}, suite hash {}",
                     profile.empty() ? "none" : profile,
                     filter.empty() ? "" : fmt::format(" (only cells that match `{}`)", filter),
                     text_at(*paper.info, {"run"}), commit_text(*paper.info),
                     text_at(*paper.info, {"environment", "machine"}), paper.suite_hash);
}

/// "value, expected >= 0.95; ...", what was measured beside what the paper's words ask for.
std::string measured(const LedgerRow& row) {
  std::string text;
  std::size_t told = 0;
  const std::size_t count = row.published.size() + row.corrected.size();
  for (const auto* list : {&row.published, &row.corrected}) {
    for (const ClaimResult* result : *list) {
      const std::string value = claims::format_value(*result);
      if (told == kMostClaims || value.empty()) continue;
      ++told;
      const std::string name = result->claim.id.substr(row.id.size());
      text += fmt::format("{}{}{}", text.empty() ? "" : "; ",
                          name.empty() ? "" : name.substr(1) + ": ", value);
      if (!result->claim.expect.empty()) text += fmt::format(" ({})", result->claim.expect);
    }
  }
  if (told < count && told > 0) text += fmt::format("; {} more", count - told);
  return text;
}

std::string printed(const LedgerRow& row) {
  std::string text;
  for (const ClaimResult* result : row.published) {
    if (result->claim.printed.empty()) continue;
    text += (text.empty() ? "" : "; ") + result->claim.printed;
  }
  return text;
}

/// Why a row is not simply reproduced: the first reason of a claim that is not, or that is open.
std::string why(const LedgerRow& row) {
  if (!row.why_unmeasured.empty()) return row.why_unmeasured;
  using enum claims::Verdict;
  for (const claims::Verdict verdict : {not_reproduced, inconclusive, not_comparable}) {
    for (const ClaimResult* result : row.published) {
      if (result->verdict == verdict && !result->reason.empty()) return result->reason;
    }
  }
  return "";
}

std::vector<TableCell> cells_of(const LedgerRow& row) {
  const auto& any = row.published.empty() ? row.corrected : row.published;
  const std::string best = row.corrected.empty() ? "" : claims::to_words(row.corrected_state);
  return {words(row.id),
          words(any.empty() ? "" : any.front()->claim.item),
          words(any.empty() ? "" : any.front()->claim.says),
          words(claims::to_words(row.state)),
          words(best),
          words(measured(row)),
          words(printed(row)),
          words(why(row))};
}

}  // namespace

std::string papers_markdown(std::span<const Paper> papers) {
  Table table = table_of({"suite", "paper"});
  for (const RowState state : claims::kRowStates) {
    table.columns.push_back({claims::to_words(state), "", Direction::none, true});
  }
  for (const Paper& paper : papers) {
    std::vector<TableCell> row{words(paper.suite), words(paper.ledger.source)};
    const auto counts = count_states(paper);
    for (const RowState state : claims::kRowStates) {
      std::size_t count = 0;
      for (const auto& [one, number] : counts) count += one == state ? number : 0;
      row.push_back(words(std::to_string(count)));
    }
    table.rows.push_back(std::move(row));
  }
  std::string text =
      "# What the papers claim\nEvery table, figure and sentence of the papers that claims "
      "something is a row; its claims, with bounds that were written before they were measured, "
      "are "
      "in the suites of `suites/catalog/papers/`. Written by `discern papers`, never by hand.\n\n";
  text += to_markdown(table) + "\n";
  for (const Paper& paper : papers) {
    text += paper.info ? fmt::format("- [{0}]({0}.md): {1}\n", paper.suite, run_line(paper))
                       : fmt::format("- {}: no run\n", paper.suite);
  }
  return text;
}

std::string paper_markdown(const Paper& paper) {
  Table table = table_of({"row", "where", "says", "verdict", "corrected preset",
                          "measured (expected)", "paper prints", "why"});
  for (const LedgerRow& row : paper.rows) table.rows.push_back(cells_of(row));
  std::string text =
      fmt::format("# {}\n{}\n\n{}\n\n", paper.suite, paper.ledger.source, run_line(paper));
  text += to_markdown(table);
  if (!paper.figures.empty()) text += "\n## Figures\n";
  for (const PaperFigure& figure : paper.figures) {
    text += figure.file.empty() ? fmt::format("`{}`: {}\n\n", figure.id, figure.error)
                                : fmt::format("![{}]({})\n`{}` {}\n\n", figure.id, figure.file,
                                              figure.id, figure.title);
  }
  return text;
}

}  // namespace results::html_report
