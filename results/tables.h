#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/run_summary.h"

namespace results {

/// Which way a column's numbers are better; a place name has none.
enum class Direction { none, lower, higher };

struct TableColumn {
  std::string title;
  std::string unit{};  ///< "" if it has none
  Direction better = Direction::none;
  bool is_number = false;  ///< aligned right
};

/// A value as it is printed, and as it sorts.
struct TableCell {
  std::string text;
  std::optional<double> sort_value{};       ///< absent: sorts last (numbers) or by its text
  bool is_marked = false;                   ///< a good part of the error is noise of the reference
  std::string note{};                       ///< printed after the text, or below it; "" for none
  std::optional<int> shade = std::nullopt;  ///< 0 (good) to 4 (bad), where there is colour
  std::optional<Estimate> estimate = std::nullopt;  ///< the number, unrounded
  bool is_best = false;  ///< of its column in its scene, beyond the noise (mark_best)
};

/// What every output of numbers starts from: terminal text, HTML, Markdown, CSV, LaTeX.
struct Table {
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;  ///< each as long as `columns`
  std::vector<std::string> notes;            ///< what marks and units mean
};

/// scene, method, budget, repetitions, median total time, where measured those of a new view and of
/// the next frame (p50 and p95 over frames), every score against own and full, status; a row per
/// (scene, method, budget).
Table summary_table(const RunSummary& summary);

/// What ± means in a summary's times and scores: short series have a range, not an interval.
std::string interval_note(const RunSummary& summary);

/// Aligned columns with a header of titles and units, at most one line per row, then the notes.
std::string to_text(const Table& table);

/// "1.24 s ±2 %": the larger half of the interval relative to the value.
std::string format_time(const Estimate& seconds);
/// "0.0123 ±0.0004": the larger half of the interval with two digits.
std::string format_score(const Estimate& score);
/// "0.0123 ±0.0004", "∞" for images identical to the reference, either followed by " (3 of 4
/// seeds)" if seeds have no part in it; else as `format_missing_score`.
std::string format_score(const SummaryRow& row, const ScoreSummary& score);
/// "worst 0.05 at 12": the score and the number of a sequence's worst frame; "" for a single frame.
std::string format_worst_frame(const ScoreSummary& score);
/// "3 of 4 seeds" for a score that seeds of the row have no part in: they failed, have no score
/// yet, or one that is not finite. "" for a score of all seeds, and for none.
std::string format_left_out_seeds(const SummaryRow& row, const ScoreSummary& score);
/// "ok 4, timeout 1"; "not yet" for a row without records.
std::string format_statuses(const SummaryRow& row);
/// "n/a" (not a number, or a sequence metric on a single frame), "not yet" (no record), "-" (the
/// method failed, of a sequence metric before its second frame, or was not run).
std::string format_missing_score(const SummaryRow& row, const ScoreSummary& score);
/// What stands beside a score: `format_worst_frame`, or why a sequence metric has none, "not a
/// sequence"; "" for nothing.
std::string format_score_note(const SummaryRow& row, const ScoreSummary& score);
/// What a score of a sequence is; says of the sequence metrics among those named what theirs is.
std::string sequence_score_note(const std::vector<std::string>& metrics);

}  // namespace results
