#include "results/html_report/papers_page.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/html_report/chip.h"
#include "results/html_report/claims_section.h"
#include "results/html_report/html_text.h"
#include "results/html_report/json_text.h"
#include "results/html_report/page_frame.h"
#include "results/html_report/run_facts.h"

namespace results::html_report {

namespace {

using claims::LedgerRow;
using claims::RowState;

ChipLook look_of(RowState state) {
  switch (state) {
    case RowState::reproduced:
      return kGoodLook;
    case RowState::in_part:
      return {kOpenLook.css, "◐"};
    case RowState::not_reproduced:
      return kBadLook;
    case RowState::inconclusive:
      return kOpenLook;
    case RowState::not_comparable:
      return kApartLook;
    case RowState::printed:
      return kPlainLook;
    case RowState::unmeasured:
      break;
  }
  return {kApartLook.css, "○"};
}

std::string state_chip(RowState state, const std::string& count = "") {
  return chip(look_of(state), claims::to_words(state) + count);
}

std::string header(std::span<const Paper> papers) {
  std::string html =
      "<header><h1>What the papers claim</h1>\n<p class=\"lead\">Every table, figure and sentence "
      "that claims something, measured.</p>\n</header>\n<nav>";
  for (const Paper& paper : papers) {
    html += fmt::format("<a href=\"#{0}\">{0}</a>", escape(paper.suite));
  }
  return html + "</nav>\n";
}

/// How many rows are in each state, a table row per paper.
std::string overview(std::span<const Paper> papers) {
  std::string rows;
  for (const Paper& paper : papers) {
    std::string counts;
    for (const auto& [state, count] : count_states(paper)) {
      counts += state_chip(state, fmt::format(" {}", count)) + " ";
    }
    const std::string profile = paper.info ? text_at(*paper.info, {"profile"}) : "";
    rows += word_row({fmt::format("<a href=\"#{0}\">{0}</a><small>{1}</small>", escape(paper.suite),
                                  escape(paper.ledger.source)),
                      escape(paper.info ? (profile.empty() ? "all" : profile) : "no run"), counts});
  }
  return "<section id=\"overview\"><h2>Overview</h2>\n" +
         word_table({"paper", "profile", "rows"}, rows) +
         "<p class=\"note\">The verdict on a row is that on the technique as published; claims "
         "whose id has <code>best</code> are of the corrected preset and stand apart. In part: "
         "some "
         "of its claims are reproduced, some are not. Not comparable are times of other hardware, "
         "scenes that are lost, and films.</p>\n</section>\n";
}

std::string run_facts(const Paper& paper) {
  if (!paper.info) {
    return fmt::format(
        "<p class=\"warning\">There is no run of this suite; make one with "
        "<code>discern run papers/{}</code>.</p>\n",
        escape(paper.suite));
  }
  std::string html = "<dl class=\"facts\">";
  html += fact("run", text_at(*paper.info, {"run"}));
  html += fact("profile", text_at(*paper.info, {"profile"}));
  html += fact("only cells that match", text_at(*paper.info, {"filter"}));
  html += fact("state", state_text(*paper.info));
  html += fact("machine", text_at(*paper.info, {"environment", "machine"}));
  html += fact("commit", commit_text(*paper.info));
  html += fact("suite hash", paper.suite_hash);
  return html + "</dl>\n";
}

std::string ledger_row(const LedgerRow& row) {
  std::string verdicts = state_chip(row.state);
  if (!row.corrected.empty()) {
    verdicts += " <span class=\"unit\">corrected preset</span> " + state_chip(row.corrected_state);
  }
  if (!row.why_unmeasured.empty()) verdicts += " " + escape(row.why_unmeasured);
  std::string html =
      fmt::format("<tr class=\"ledger\" id=\"{0}\"><th colspan=\"6\">{0} {1}</th></tr>\n",
                  escape(row.id), verdicts);
  for (const auto* list : {&row.published, &row.corrected}) {
    for (const claims::ClaimResult* result : *list) html += claim_row(*result);
  }
  return html;
}

std::string figures_of(const Paper& paper) {
  if (paper.figures.empty()) return "";
  std::string html = "<h3>Figures</h3>\n<div class=\"pictures paper-figures\">\n";
  for (const PaperFigure& figure : paper.figures) {
    const std::string picture =
        figure.file.empty()
            ? fmt::format("<div class=\"no-picture\">{}</div>", escape(figure.error))
            : fmt::format(
                  "<a href=\"{0}\"><img class=\"picture\" src=\"{0}\" alt=\"{1}\" "
                  "loading=\"lazy\"></a>",
                  escape(figure.file), escape(figure.id));
    html += fmt::format("<figure>{}<figcaption><b>{}</b><span>{}</span></figcaption></figure>\n",
                        picture, escape(figure.id), escape(figure.title));
  }
  return html + "</div>\n";
}

std::string paper_section(const Paper& paper) {
  std::string html =
      fmt::format("<section id=\"{}\"><h2>{}</h2>\n<p class=\"note\">{}</p>\n", escape(paper.suite),
                  escape(paper.suite), escape(paper.ledger.source));
  html += run_facts(paper);
  std::string rows;
  for (const LedgerRow& row : paper.rows) rows += ledger_row(row);
  html += fmt::format(
      "<div class=\"scroll\"><table class=\"words\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody>"
      "</table></div>\n",
      claim_titles(), rows);
  return html + figures_of(paper) + "</section>\n";
}

}  // namespace

std::vector<std::pair<RowState, std::size_t>> count_states(const Paper& paper) {
  std::vector<std::pair<RowState, std::size_t>> counts;
  for (const RowState state : claims::kRowStates) {
    const auto count = std::ranges::count(paper.rows, state, &LedgerRow::state);
    if (count > 0) counts.emplace_back(state, static_cast<std::size_t>(count));
  }
  return counts;
}

std::string papers_page(std::span<const Paper> papers) {
  std::string body = header(papers) + "<main>\n" + overview(papers);
  for (const Paper& paper : papers) body += paper_section(paper);
  return page_frame("What the papers claim", body + "</main>\n", Files::beside);
}

}  // namespace results::html_report
