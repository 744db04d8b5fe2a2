#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include <fmt/format.h>

#include "perception/base/quantile.h"
#include "perception/base/units.h"
#include "results/html_report/html_table.h"
#include "results/html_report/html_text.h"
#include "results/html_report/sections.h"
#include "results/html_report/stage_bars.h"
#include "results/tables.h"

namespace results::html_report {

namespace {

std::string duration_or_dash(double seconds) {
  return std::isfinite(seconds) && seconds >= 0.0 ? base::format_duration(seconds) : "–";
}

std::string axis(double full_scale_s) {
  std::string ticks;
  for (const double tick : axis_ticks(full_scale_s)) {
    ticks += fmt::format("<span style=\"left:{:.3f}%\">{}</span>", 100.0 * tick / full_scale_s,
                         base::format_duration(tick));
  }
  return "<div class=\"axis\">" + ticks + "</div>";
}

std::string stage_row(const RenderRecord& record, const renderers::StageRecord& stage) {
  const auto depth = std::count(stage.path.begin(), stage.path.end(), '/');
  const std::string name = stage.path.substr(stage.path.rfind('/') + 1);
  const bool is_counted = !is_readback(stage) && stage.phase != renderers::Phase::new_view;
  const std::string share =
      is_counted ? base::format_significant(100.0 * stage.wall_s / timed_s(record), 3)
                 : "not in total";
  return fmt::format(
      "<tr><td></td><td>{}</td><td class=\"depth-{}\"><i class=\"swatch {}\"></i>{}</td>"
      "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td>"
      "<td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
      renderers::to_string(stage.phase), std::min<long>(depth, 3),
      stage_class(stage.path.substr(0, stage.path.find('/'))), escape(name),
      duration_or_dash(stage.wall_s), duration_or_dash(stage.cpu_s), duration_or_dash(stage.gpu_s),
      renderers::to_string(stage.clock), share, stage.calls);
}

std::string summary_row(const char* name, double wall_s, const std::string& share) {
  return fmt::format(
      "<tr class=\"sum\"><td></td><td></td><td>{}</td><td class=\"n\">{}</td>"
      "<td></td><td></td><td></td><td class=\"n\">{}</td><td></td></tr>\n",
      name, base::format_duration(wall_s), share);
}

std::string method_rows(const std::string& label, const RenderRecord& record) {
  std::string rows =
      fmt::format("<tr class=\"group\"><th colspan=\"9\">{}</th></tr>\n", escape(label));
  for (const renderers::StageRecord& stage : stages_of_total(record)) {
    rows += stage_row(record, stage);
  }
  const double total_s = timed_s(record);
  rows += summary_row("unattributed", record.unattributed_s,
                      base::format_significant(100.0 * record.unattributed_s / total_s, 3));
  rows += summary_row(record.next_frame_s ? "next frame" : "total", total_s, "100");
  if (record.new_view_s) rows += summary_row("new view", *record.new_view_s, "not in total");
  if (record.start_up_s > 0.0 && !record.next_frame_s) {
    rows += summary_row("start-up (warm libraries)", record.start_up_s, "not in total");
  }
  return rows;
}

/// One bar: the record it shows, or null, and what is written beside it.
struct LabelledBar {
  std::string label;
  const RenderRecord* record = nullptr;
  std::string text;  ///< right of the bar, or in its place
};

/// Bars of one scale with their axis; appends their rows to the table of numbers.
std::string bars_of(const std::vector<LabelledBar>& bars, std::string& table_rows) {
  double longest_s = 0.0;
  std::vector<const RenderRecord*> records;
  for (const LabelledBar& bar : bars) {
    if (bar.record == nullptr) continue;
    records.push_back(bar.record);
    longest_s = std::max(longest_s, timed_s(*bar.record));
  }
  if (!(longest_s > 0.0)) return "<p class=\"note\">not yet</p>\n";
  std::string html = stage_legend(records) + "<div class=\"bars\">\n";
  for (const LabelledBar& bar : bars) {
    html += fmt::format("<div class=\"bar-label\">{}</div>", escape(bar.label));
    if (bar.record == nullptr) {
      html += fmt::format("<div class=\"note\">{}</div><div></div>\n", escape(bar.text));
      continue;
    }
    html += fmt::format("{}<div class=\"bar-total\">{}</div>\n", stage_bar(*bar.record, longest_s),
                        escape(bar.text));
    table_rows += method_rows(bar.label, *bar.record);
  }
  return html + "<div></div>" + axis(longest_s) + "<div></div></div>\n";
}

std::vector<LabelledBar> total_bars(const ReportData& data, const SceneView& scene) {
  std::vector<LabelledBar> bars;
  for (const SummaryRow* row : scene.rows) {
    LabelledBar bar{row_label(data, *row), nullptr, format_statuses(*row)};
    if (row->typical) {
      bar.record = &data.run.cells[*row->typical].render;
      bar.text = format_time(*row->total_s);
    }
    bars.push_back(std::move(bar));
  }
  return bars;
}

/// The typical following frame of every sequence; empty if there is none.
std::vector<LabelledBar> next_frame_bars(const ReportData& data, const SceneView& scene) {
  std::vector<LabelledBar> bars;
  for (const SummaryRow* row : scene.rows) {
    if (!row->next_frames.typical) continue;
    const RenderRecord& record = data.run.cells[*row->next_frames.typical].render;
    bars.push_back({fmt::format("{}, frame {}", row_label(data, *row), record.frame), &record,
                    base::format_duration(timed_s(record))});
  }
  return bars;
}

/// "30", of a series "28 (26 to 30 in 60 values)": its median and its range.
TableCell counter_cell(const renderers::CounterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    return {fmt::format("{:.6g}", *number), *number, false, "", {}};
  }
  const auto& series = std::get<std::vector<double>>(value);
  if (series.empty()) return {"-", std::nullopt, false, "", {}};
  const auto [low, high] = std::minmax_element(series.begin(), series.end());
  const double median = base::median(series);
  return {fmt::format("{:.6g}", median),
          median,
          false,
          fmt::format("{:.6g} to {:.6g} in {} values", *low, *high, series.size()),
          {}};
}

/// Names of counters of these rows, in the order of their first appearance.
std::vector<std::string> counter_names(const std::vector<LabelledBar>& bars) {
  std::vector<std::string> names;
  for (const LabelledBar& bar : bars) {
    if (bar.record == nullptr) continue;
    for (const auto& [name, value] : bar.record->counters) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

/// What the renderers counted in the repetitions of the bars: a column per counter.
std::string counter_table(const std::vector<LabelledBar>& bars, const std::string& anchor) {
  const std::vector<std::string> names = counter_names(bars);
  if (names.empty()) return "";
  Table table;
  table.columns.push_back({"method", "", Direction::none, false});
  for (const std::string& name : names) table.columns.push_back({name, "", Direction::none, true});
  for (const LabelledBar& bar : bars) {
    if (bar.record == nullptr) continue;
    std::vector<TableCell> row{{bar.label, std::nullopt, false, "", {}}};
    for (const std::string& name : names) {
      const auto& counters = bar.record->counters;
      const auto found = std::find_if(counters.begin(), counters.end(),
                                      [&](const auto& counter) { return counter.first == name; });
      row.push_back(found == counters.end() ? TableCell{"-", std::nullopt, false, "", {}}
                                            : counter_cell(found->second));
    }
    table.rows.push_back(std::move(row));
  }
  return "<details><summary>Counters</summary>\n" + html_table(table, anchor + "-counters") +
         "</details>\n";
}

}  // namespace

std::string stage_part(const ReportData& data, const SceneView& scene) {
  std::string table_rows;
  std::string html =
      "<h3>Time by stage</h3>\n<p class=\"note\">Stages of the repetition with the median total "
      "time; all bars of this scene share one scale. Total = prepare + render, without reading the "
      "image back.</p>\n" +
      bars_of(total_bars(data, scene), table_rows);
  const std::string counters = counter_table(total_bars(data, scene), scene.anchor);
  const std::vector<LabelledBar> next_frames = next_frame_bars(data, scene);
  if (!next_frames.empty()) {
    html +=
        "<h4>Next frame</h4>\n<p class=\"note\">Stages of the following frame with the median "
        "time, update + render; a scale of its own.</p>\n" +
        bars_of(next_frames, table_rows);
  }
  if (table_rows.empty()) return html + counters;
  return html +
         "<details><summary>Stages in numbers</summary><div class=\"scroll\">"
         "<table class=\"numbers stages\"><thead><tr><th></th><th>phase</th><th>stage</th>"
         "<th>wall</th><th>CPU</th><th>GPU</th><th>clock</th><th>share of total, %</th>"
         "<th>calls</th></tr></thead><tbody>\n" +
         table_rows + "</tbody></table></div></details>\n" + counters;
}

}  // namespace results::html_report
