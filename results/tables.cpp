#include "results/tables.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "metrics/metric_list.h"
#include "perception/base/units.h"

namespace results {

namespace {

constexpr const char* kNoiseFloorNote = "~ more than a tenth of it is noise of the reference";

Direction direction_of(const std::string& metric) {
  const metrics::MetricDescription* info = metric_info_of(metric);
  if (info == nullptr) return Direction::none;
  return info->better == metrics::Better::lower ? Direction::lower : Direction::higher;
}

std::string unit_of(const std::string& metric) {
  const metrics::MetricDescription* info = metric_info_of(metric);
  return info == nullptr ? std::string() : info->unit;
}

double half_width(const Estimate& estimate) {
  return std::max(estimate.high - estimate.value, estimate.value - estimate.low);
}

TableCell text_cell(const std::string& text) { return {text, std::nullopt, false, ""}; }

TableCell time_cell(const SummaryRow& row, const std::optional<Estimate>& seconds) {
  if (seconds) {
    return {format_time(*seconds), seconds->value, false, "", std::nullopt, seconds};
  }
  return text_cell(row.repetitions == 0 ? "not yet" : "-");
}

/// A column of times: its title, what it holds, and the note that explains it.
struct TimeColumn {
  const char* title;
  const char* unit;
  std::optional<Estimate> (*of)(const SummaryRow& row);
  const char* note;
};

constexpr const char* kSequenceNote =
    "next frame: update + render, what half (p50) and 95 % (p95) of the frames stay below; total "
    "is the first frame";

/// Those that every run has, and those that some row of this one has.
std::vector<TimeColumn> time_columns(const RunSummary& summary) {
  const TimeColumn total{"total", "median", [](const SummaryRow& row) { return row.total_s; },
                         nullptr};
  const std::array<TimeColumn, 3> optional_columns{
      {{"new view", "median", [](const SummaryRow& row) { return row.new_view_s; },
        "new view: the same scene once more, the camera turned a little"},
       {"next frame", "p50", [](const SummaryRow& row) { return row.next_frames.p50_s; }, nullptr},
       {"next frame", "p95", [](const SummaryRow& row) { return row.next_frames.p95_s; },
        kSequenceNote}}};
  std::vector<TimeColumn> columns{total};
  for (const TimeColumn& column : optional_columns) {
    const bool is_measured =
        std::any_of(summary.rows.begin(), summary.rows.end(),
                    [&](const SummaryRow& row) { return column.of(row).has_value(); });
    if (is_measured) columns.push_back(column);
  }
  return columns;
}

bool is_range(const std::optional<Estimate>& estimate) {
  return estimate && estimate->count > 1 && estimate->count < kFewestForMedianInterval;
}

TableCell score_cell(const SummaryRow& row, const ScoreSummary& score) {
  const std::string mark = score.has_reference_noise ? "~" : "";
  return {mark + format_score(row, score), score.value(), score.has_reference_noise,
          format_score_note(row, score),   std::nullopt,  score.score};
}

/// Whether the metric has nothing to score: it is one of sequences, the scene a single frame.
bool lacks_sequence(const SummaryRow& row, const ScoreSummary& score) {
  return is_sequence_metric(score.metric) && !row.is_sequence;
}

/// Columns of a terminal that a UTF-8 text takes: its code points; we print no wide ones.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string padded(const std::string& text, std::size_t width, bool is_right_aligned) {
  const std::string blanks(width - std::min(width, width_of(text)), ' ');
  return is_right_aligned ? blanks + text : text + blanks;
}

std::string printed(const TableCell& cell) {
  return cell.note.empty() ? cell.text : cell.text + ", " + cell.note;
}

std::string title_of(const TableColumn& column) {
  const char* arrow = column.better == Direction::lower    ? " ↓"
                      : column.better == Direction::higher ? " ↑"
                                                           : "";
  return column.title + arrow;
}

void append_line(std::string& text, const std::vector<std::string>& cells, const Table& table,
                 const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += "  ";
    line += padded(cells[i], widths[i], table.columns[i].is_number);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  text += line + "\n";
}

}  // namespace

std::string format_time(const Estimate& seconds) {
  const std::string value = base::format_duration(seconds.value);
  if (seconds.count < 2 || seconds.value <= 0.0) return value;
  const double percent = 100.0 * half_width(seconds) / seconds.value;
  return fmt::format("{} ±{} %", value,
                     percent < 0.1 ? "<0.1" : base::format_significant(percent, 2));
}

std::string format_score(const Estimate& score) {
  const std::string value = base::format_significant(score.value, 3);
  if (score.count < 2) return value;
  return fmt::format("{} ±{}", value, base::format_significant(half_width(score), 2));
}

std::string format_score(const SummaryRow& row, const ScoreSummary& score) {
  if (!score.value()) return format_missing_score(row, score);
  const std::string value = score.score ? format_score(*score.score) : "∞";
  const std::string seeds = format_left_out_seeds(row, score);
  return seeds.empty() ? value : fmt::format("{} ({})", value, seeds);
}

std::string format_worst_frame(const ScoreSummary& score) {
  if (!score.worst) return "";
  return fmt::format("worst {} at {}", base::format_significant(score.worst->value, 3),
                     score.worst->frame);
}

std::string format_left_out_seeds(const SummaryRow& row, const ScoreSummary& score) {
  if (!score.value() || score.seeds() >= row.seeds) return "";
  return fmt::format("{} of {} seeds", score.seeds(), row.seeds);
}

std::string format_statuses(const SummaryRow& row) {
  std::string text;
  const auto add = [&](const std::string& name, std::size_t count) {
    if (!text.empty()) text += ", ";
    text += count == 1 && row.repetitions + row.missing_cells == 1
                ? name
                : fmt::format("{} {}", count, name);
  };
  for (const auto& [status, count] : row.statuses) add(to_string(status), count);
  if (row.missing_cells > 0) add("not yet", row.missing_cells);
  return text;
}

std::string format_missing_score(const SummaryRow& row, const ScoreSummary& score) {
  if (!score.is_wanted || score.non_finite > 0 || lacks_sequence(row, score)) return "n/a";
  const bool has_frames = row.frames >= (is_sequence_metric(score.metric) ? 2 : 1);
  return row.repetitions == 0 || has_frames ? "not yet" : "-";
}

std::string format_score_note(const SummaryRow& row, const ScoreSummary& score) {
  return lacks_sequence(row, score) ? "not a sequence" : format_worst_frame(score);
}

std::string sequence_score_note(const std::vector<std::string>& metrics) {
  std::string note = "of a sequence a score is the median over the frames";
  std::string names;
  for (const std::string& metric : metrics) {
    if (is_sequence_metric(metric)) names += (names.empty() ? "" : ", ") + metric;
  }
  if (names.empty()) return note;
  return note + fmt::format("; of {}, the change from frame to frame, the mean", names);
}

std::string interval_note(const RunSummary& summary) {
  const bool has_ranges =
      std::any_of(summary.rows.begin(), summary.rows.end(), [](const SummaryRow& row) {
        return is_range(row.total_s) || is_range(row.new_view_s) || is_range(row.next_frames.p50_s);
      });
  std::string note = "± is the 95 % interval";
  if (has_ranges) {
    note += fmt::format("; for times of fewer than {} repetitions it is their range",
                        kFewestForMedianInterval);
  }
  return note;
}

namespace {

/// Whether the suite asks for the score with this position of any row.
bool is_wanted(const RunSummary& summary, std::size_t score) {
  return summary.rows.empty() ||
         std::any_of(summary.rows.begin(), summary.rows.end(),
                     [&](const SummaryRow& row) { return row.scores[score].is_wanted; });
}

}  // namespace

Table summary_table(const RunSummary& summary) {
  Table table;
  table.columns = {{"scene", "", Direction::none, false},
                   {"method", "", Direction::none, false},
                   {"budget", "", Direction::none, false},
                   {"reps", "", Direction::none, true}};
  const std::vector<TimeColumn> times = time_columns(summary);
  for (const TimeColumn& time : times) {
    table.columns.push_back({time.title, time.unit, Direction::lower, true});
  }
  std::vector<std::size_t> scores;
  for (const std::string& metric : summary.metrics) {
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const std::size_t score =
          2 * static_cast<std::size_t>(&metric - summary.metrics.data()) + side;
      if (!is_wanted(summary, score)) continue;
      scores.push_back(score);
      table.columns.push_back({fmt::format("{} ({})", metric, side == 0 ? "own" : "full"),
                               unit_of(metric), direction_of(metric), true});
    }
  }
  table.columns.push_back({"status", "", Direction::none, false});

  bool has_mark = false;
  for (const SummaryRow& row : summary.rows) {
    const double repetitions = static_cast<double>(row.repetitions);
    std::vector<TableCell> cells{text_cell(row.scene),
                                 text_cell(row.method),
                                 text_cell(row.budget),
                                 {std::to_string(row.repetitions), repetitions, false, ""}};
    for (const TimeColumn& time : times) cells.push_back(time_cell(row, time.of(row)));
    for (const std::size_t score : scores) cells.push_back(score_cell(row, row.scores[score]));
    cells.push_back(text_cell(format_statuses(row)));
    for (const TableCell& cell : cells) has_mark = has_mark || cell.is_marked;
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back("↓ lower is better, ↑ higher is better; " + interval_note(summary));
  table.notes.emplace_back(
      "(own) against the transport the method claims, (full) against all light");
  for (const TimeColumn& time : times) {
    if (time.note != nullptr) table.notes.emplace_back(time.note);
  }
  const bool has_sequence = std::any_of(summary.rows.begin(), summary.rows.end(),
                                        [](const SummaryRow& row) { return row.is_sequence; });
  if (has_sequence) table.notes.push_back(sequence_score_note(summary.metrics));
  if (has_mark) table.notes.emplace_back(kNoiseFloorNote);
  return table;
}

std::string to_text(const Table& table) {
  std::vector<std::string> titles;
  std::vector<std::string> units;
  std::vector<std::size_t> widths;
  for (const TableColumn& column : table.columns) {
    titles.push_back(title_of(column));
    units.push_back(column.unit);
    widths.push_back(std::max(width_of(titles.back()), width_of(units.back())));
  }
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], width_of(printed(row[i])));
    }
  }
  std::string text;
  append_line(text, titles, table, widths);
  append_line(text, units, table, widths);
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const TableCell& cell : row) cells.push_back(printed(cell));
    append_line(text, cells, table, widths);
  }
  for (const std::string& note : table.notes) text += note + "\n";
  return text;
}

}  // namespace results
