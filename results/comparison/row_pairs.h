#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/run_summary.h"
#include "results/run_values.h"

namespace results::comparison {

/// A row of the summary in both runs; one is null if that run lacks it.
struct RowPair {
  const SummaryRow* before = nullptr;
  const SummaryRow* after = nullptr;
  std::size_t before_index = 0;
  std::size_t after_index = 0;

  const SummaryRow& any() const { return after != nullptr ? *after : *before; }
};

/// By scene, method and budget, in the order of the later run, then what only the earlier one has.
std::vector<RowPair> paired_rows(const RunSummary& before, const RunSummary& after);

/// The first record of a row, which speaks for all of what it was rendered with; null without one.
const CellRecord* first_record(const Run& run, const SummaryRow& row);

/// Why two rows may not be compared at all; "" if they may.
std::string difference_of_pictures(const RenderRecord& before, const RenderRecord& after);
/// Why their times may not be.
std::string difference_of_machines(const CellRecord& before, const CellRecord& after);
/// The first record of a score of a row; null without one.
const MetricRecord* first_score(const Run& run, const SummaryRow& row, const Quantity& score);
/// Why two scores are not of the same kind: another reference, metric version or viewing
/// conditions. "" if they are.
std::string difference_of_scores(const MetricRecord* before, const MetricRecord* after);
/// "vals 30 -> 20" of parameters that both have and that differ.
std::vector<std::string> changed_parameters(const RenderRecord& before, const RenderRecord& after);

/// Top-level stages of a row, in the order of its records, without `readback`.
std::vector<std::string> stages_of(const Run& run, const SummaryRow& row);

}  // namespace results::comparison
