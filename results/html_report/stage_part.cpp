#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/html_report/html_text.h"
#include "results/html_report/sections.h"
#include "results/html_report/stage_bars.h"
#include "results/tables.h"

namespace results::html_report {

namespace {

/// The repetition a row's stages are shown of, or null.
const RenderRecord* typical_record(const ReportData& data, const SummaryRow& row) {
  return row.typical ? &data.run.cells[*row.typical].render : nullptr;
}

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
  const std::string share =
      is_readback(stage) ? "not in total"
                         : base::format_significant(100.0 * stage.wall_s / record.total_s, 3);
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
  rows += summary_row("unattributed", record.unattributed_s,
                      base::format_significant(100.0 * record.unattributed_s / record.total_s, 3));
  rows += summary_row("total", record.total_s, "100");
  if (record.start_up_s > 0.0) {
    rows += summary_row("start-up (warm libraries)", record.start_up_s, "not in total");
  }
  return rows;
}

}  // namespace

std::string stage_part(const ReportData& data, const SceneView& scene) {
  std::vector<const RenderRecord*> records;
  double longest_s = 0.0;
  for (const SummaryRow* row : scene.rows) {
    const RenderRecord* record = typical_record(data, *row);
    if (record == nullptr) continue;
    records.push_back(record);
    longest_s = std::max(longest_s, record->total_s);
  }
  std::string html = "<h3>Time by stage</h3>\n";
  if (!(longest_s > 0.0)) return html + "<p class=\"note\">not yet</p>\n";

  html +=
      "<p class=\"note\">Stages of the repetition with the median total time; all bars of this "
      "scene share one scale. Total = prepare + render, without reading the image back."
      "</p>\n" +
      stage_legend(records) + "<div class=\"bars\">\n";
  std::string table_rows;
  for (const SummaryRow* row : scene.rows) {
    const RenderRecord* record = typical_record(data, *row);
    const std::string label = row_label(data, *row);
    html += fmt::format("<div class=\"bar-label\">{}</div>", escape(label));
    if (record == nullptr) {
      html +=
          fmt::format("<div class=\"note\">{}</div><div></div>\n", escape(format_statuses(*row)));
      continue;
    }
    html += fmt::format("{}<div class=\"bar-total\">{}</div>\n", stage_bar(*record, longest_s),
                        escape(format_time(*row->total_s)));
    table_rows += method_rows(label, *record);
  }
  html += "<div></div>" + axis(longest_s) + "<div></div></div>\n";
  html +=
      "<details><summary>Stages in numbers</summary><div class=\"scroll\">"
      "<table class=\"numbers stages\"><thead><tr><th></th><th>phase</th><th>stage</th>"
      "<th>wall</th><th>CPU</th><th>GPU</th><th>clock</th><th>share of total, %</th>"
      "<th>calls</th></tr></thead><tbody>\n" +
      table_rows + "</tbody></table></div></details>\n";
  return html;
}

}  // namespace results::html_report
