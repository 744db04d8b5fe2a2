#include "results/html_report/claims_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/claims/judgement.h"
#include "results/html_report/chip.h"
#include "results/html_report/html_text.h"

namespace results::html_report {

namespace {

using claims::ClaimPart;
using claims::ClaimResult;
using claims::Verdict;

ChipLook look_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::reproduced:
      return kGoodLook;
    case Verdict::not_reproduced:
      return kBadLook;
    case Verdict::inconclusive:
      return kOpenLook;
    case Verdict::not_comparable:
      return kApartLook;
    case Verdict::printed:
      break;
  }
  return kPlainLook;
}

std::string part_rows(const std::vector<ClaimPart>& parts) {
  std::string rows;
  for (const ClaimPart& part : parts) {
    rows += fmt::format(
        "<tr><td><code>{}</code></td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "</tr>\n",
        escape(part.text), claims::format_number(part.value, part.interval),
        part.rows == 0 ? "" : std::to_string(part.rows));
  }
  return rows;
}

/// The measure, where the bound comes from and the numbers, folded.
std::string behind(const ClaimResult& result) {
  const claims::Claim& claim = result.claim;
  std::string html = "<details><summary>numbers behind</summary>";
  for (const std::string& measure : claim.measures) {
    html += fmt::format("<p><code>{}</code></p>", escape(measure));
  }
  html +=
      fmt::format("<p class=\"note\">comparable: {}{}{}</p>", escape(claim.comparable_text()),
                  claim.criterion.empty() ? "" : " · criterion: " + escape(claim.criterion),
                  claim.profiles.empty()
                      ? ""
                      : fmt::format(" · profile: {}",
                                    escape(fmt::format("{}", fmt::join(claim.profiles, ", ")))));
  if (!result.parts.empty() || !result.elements.empty()) {
    html +=
        "<table class=\"numbers\"><thead><tr><th>number</th><th class=\"n\">value<small>95 % "
        "interval</small></th><th class=\"n\">rows</th></tr></thead><tbody>\n" +
        part_rows(result.elements) + part_rows(result.parts) + "</tbody></table>";
  }
  return html + "</details>";
}

}  // namespace

std::string verdict_chip(Verdict verdict, const std::string& count) {
  return chip(look_of(verdict), claims::to_words(verdict) + count);
}

std::string claim_row(const ClaimResult& result) {
  const claims::Claim& claim = result.claim;
  const std::string reason =
      result.reason.empty() ? "" : fmt::format("<small>{}</small>", escape(result.reason));
  return fmt::format(
      "<tr id=\"claim-{}\"><td>{}{}</td><td><b>{}</b><small>{}</small></td><td>{}{}</td>"
      "<td>{}</td><td>{}</td><td>{}</td></tr>\n",
      escape(claim.id), verdict_chip(result.verdict, ""), reason, escape(claim.id),
      escape(claim.item), escape(claim.says), behind(result), claims::format_value(result),
      escape(claim.expect), escape(claim.printed));
}

std::string claim_titles() {
  return "<th>verdict</th><th>claim</th><th>what it says</th><th>value</th><th>expected</th>"
         "<th>paper prints</th>";
}

std::string claims_section(std::span<const ClaimResult> results) {
  if (results.empty()) return "";
  std::string counts;
  std::string rows;
  for (const auto& [verdict, count] : claims::count_verdicts(results)) {
    counts += verdict_chip(verdict, fmt::format(" {}", count)) + " ";
  }
  for (const ClaimResult& result : results) rows += claim_row(result);
  return fmt::format(
      "<section id=\"claims\"><h2>Claims</h2>\n<p>{}</p>\n<p class=\"note\">[ ] is the 95 % "
      "interval: repetitions of times and seeds of scores drawn again. A claim is reproduced if "
      "all of it meets what is expected, not reproduced if none of it does.</p>\n"
      "<div class=\"scroll\"><table class=\"words sortable\"><thead><tr>{}</tr></thead><tbody>\n"
      "{}</tbody></table></div></section>\n",
      counts, claim_titles(), rows);
}

}  // namespace results::html_report
