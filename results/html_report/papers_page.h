#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/claims/claim_result.h"
#include "results/claims/ledger.h"

namespace results::html_report {

/// A figure of a paper's suite, as a picture beside the page.
struct PaperFigure {
  std::string id;
  std::string title;
  std::string file;   ///< relative to the page; "" if it could not be made
  std::string error;  ///< why not; without folders, which are of the machine that drew it
};

/// A paper's suite with what its newest run says.
struct Paper {
  std::string suite;
  claims::Ledger ledger;
  /// run.json; null if there is no run
  std::shared_ptr<const nlohmann::ordered_json> info;
  std::string suite_hash;  ///< of what was measured, as resolved
  std::vector<claims::ClaimResult> results;
  std::vector<claims::LedgerRow> rows;  ///< point into `results`
  std::vector<PaperFigure> figures;
};

/// How many rows of a paper are in each state, those that occur, in the order of kRowStates.
std::vector<std::pair<claims::RowState, std::size_t>> count_states(const Paper& paper);

/// Every row of every paper: what it says, what was measured, the verdict; then the figures. The
/// pictures lie beside the page. A pure function of what was collected.
std::string papers_page(std::span<const Paper> papers);

/// The same as Markdown, without the single claims: a page with a line per paper, and a page per
/// paper, `<suite>.md`, with a line per row and the figures.
std::string papers_markdown(std::span<const Paper> papers);
std::string paper_markdown(const Paper& paper);

}  // namespace results::html_report
