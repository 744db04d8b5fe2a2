#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "metrics/metric_list.h"
#include "perception/base/units.h"
#include "results/html_report/gates_section.h"
#include "results/html_report/html_table.h"
#include "results/html_report/html_text.h"
#include "results/html_report/sections.h"
#include "results/html_report/stage_bars.h"
#include "results/tables.h"

namespace results::html_report {

namespace {

/// Only scores of all seeds of a row are ranked: the seeds left out may be the bad ones.
bool is_ranked(const SummaryRow& row, const ScoreSummary& score) {
  return score.value().has_value() && format_left_out_seeds(row, score).empty();
}

/// Rank among the methods of the scene as one of five colours, 0 best; equal scores share a rank.
std::optional<int> rank_color(const SceneView& scene, const SummaryRow& row,
                              const ScoreSummary& score) {
  const metrics::MetricDescription* info = metric_info_of(score.metric);
  if (info == nullptr || !is_ranked(row, score)) return std::nullopt;
  const double sign = info->better == metrics::Better::lower ? 1.0 : -1.0;
  std::vector<double> values;
  for (const SummaryRow* rival : scene.rows) {
    const ScoreSummary* other = rival->find_score(score.metric, score.against);
    if (other != nullptr && is_ranked(*rival, *other)) values.push_back(sign * *other->value());
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < 2) return std::nullopt;
  const auto place = std::lower_bound(values.begin(), values.end(), sign * *score.value());
  constexpr int kColors = 5;
  return static_cast<int>((place - values.begin()) * (kColors - 1) /
                          static_cast<long>(values.size() - 1));
}

std::string score_chip(const SceneView& scene, const SummaryRow& row, const ScoreSummary& score) {
  if (!score.value()) {
    const std::string reason = format_score_note(row, score);
    return fmt::format("<td class=\"none\"{}>{}</td>",
                       reason.empty() ? "" : fmt::format(" title=\"{}\"", reason),
                       format_missing_score(row, score));
  }
  const std::optional<int> rank = rank_color(scene, row, score);
  const std::string css = rank ? fmt::format(" class=\"rank-{}\"", *rank) : "";
  const char* mark = score.has_reference_noise ? "~" : "";
  const std::string value = score.score ? format_score({score.score->value, 0.0, 0.0, 1}) : "∞";
  const std::string seeds = format_left_out_seeds(row, score);
  const std::string note = seeds.empty() ? "" : fmt::format("<small>{}</small>", seeds);
  return fmt::format("<td{} title=\"{}\">{}{}{}</td>", css, format_score(row, score), mark, value,
                     note);
}

/// The scores of one method; nothing if it has none.
std::string score_list(const ReportData& data, const SceneView& scene, const SummaryRow& row) {
  const bool has_score = std::any_of(row.scores.begin(), row.scores.end(), [](const auto& score) {
    return score.value().has_value() || score.non_finite > 0;
  });
  if (!has_score) return "";
  std::string rows;
  for (const std::string& metric : data.summary.metrics) {
    const bool is_wanted =
        row.find_score(metric, "own")->is_wanted || row.find_score(metric, "full")->is_wanted;
    if (!is_wanted) continue;
    rows += fmt::format("<tr><th>{}</th>", escape(metric));
    for (const char* against : {"own", "full"}) {
      rows += score_chip(scene, row, *row.find_score(metric, against));
    }
    rows += "</tr>";
  }
  return "<table class=\"chips\"><tr><th></th><th>own</th><th>full</th></tr>" + rows + "</table>";
}

/// "✗ 2 gates failed", "✓ 3 gates passed"; nothing if none concerns the row.
std::string gate_chips(const std::vector<gates::Outcome>& outcomes) {
  std::string html;
  for (const gates::Outcome outcome : {gates::Outcome::failed, gates::Outcome::inconclusive,
                                       gates::Outcome::not_measured, gates::Outcome::passed}) {
    const auto count = std::count(outcomes.begin(), outcomes.end(), outcome);
    if (count == 0) continue;
    std::string word = gates::to_string(outcome);
    std::replace(word.begin(), word.end(), '_', ' ');
    html += outcome_chip(outcome, fmt::format("{} gate{} {}", count, count == 1 ? "" : "s", word));
  }
  return html.empty() ? "" : "<div class=\"gate-chips\">" + html + "</div>";
}

/// What the filter goes by: "ok", "failed" (by itself or a gate), "open" (not run, not yet, or a
/// gate is not decided).
std::string states_of(const SummaryRow& row, const std::vector<gates::Outcome>& outcomes) {
  const auto has = [&](gates::Outcome outcome) {
    return std::find(outcomes.begin(), outcomes.end(), outcome) != outcomes.end();
  };
  if (row.has_failure() || has(gates::Outcome::failed)) return "failed";
  const bool is_open = row.repetitions == 0 || row.missing_cells > 0 || !row.total_s ||
                       has(gates::Outcome::inconclusive) || has(gates::Outcome::not_measured);
  return is_open ? "open" : "ok";
}

std::string matrix_cell(const ReportData& data, const SceneView& scene, std::size_t index) {
  const SummaryRow& row = *scene.rows[index];
  const Picture& picture = scene.pictures[index];
  std::string html =
      picture.is_empty()
          ? fmt::format("<div class=\"no-picture\">{}</div>", escape(picture.missing))
          : fmt::format(
                "<a href=\"#{}\"><img class=\"thumbnail\" src=\"{}\" "
                "alt=\"{}, {}\"></a>",
                scene.anchor, picture.thumbnail, escape(row.method), escape(scene.name));
  std::string sort_value;
  if (row.total_s) {
    sort_value = sort_attribute(row.total_s->value);
    html += fmt::format("<div class=\"time\">{}</div>", format_time(*row.total_s));
    const RenderRecord& typical = data.run.cells[*row.typical].render;
    if (typical.total_s > 0.0) html += stage_bar(typical, typical.total_s);
  }
  if (row.next_frames.p50_s) {
    html += fmt::format("<div class=\"note\">next frame {}, p95 {}</div>",
                        format_time(*row.next_frames.p50_s),
                        base::format_duration(row.next_frames.p95_s->value));
  }
  if (row.new_view_s) {
    html += fmt::format("<div class=\"note\">new view {}</div>", format_time(*row.new_view_s));
  }
  const bool is_plain = row.statuses.size() == 1 && is_success(row.statuses.front().first);
  if (row.repetitions > 0 && (!is_plain || row.missing_cells > 0)) {
    html += fmt::format("<div class=\"status{}\">{}</div>", row.has_failure() ? " failed" : "",
                        escape(format_statuses(row)));
  }
  html += score_list(data, scene, row);
  const auto found = data.outcomes.find({row.scene, row.method, row.budget});
  const auto outcomes =
      found == data.outcomes.end() ? std::vector<gates::Outcome>() : found->second;
  html += gate_chips(outcomes);
  return fmt::format("<td{}{} data-state=\"{}\">{}</td>\n",
                     row.has_failure() ? " class=\"failed\"" : "", sort_value,
                     states_of(row, outcomes), html);
}

/// Index in the scene's rows, or nothing.
std::optional<std::size_t> find_row(const SceneView& scene, const SummaryRow& wanted) {
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    const SummaryRow& row = *scene.rows[i];
    if (row.method == wanted.method && row.budget == wanted.budget) return i;
  }
  return std::nullopt;
}

/// One row per (method, budget), in the order of the suite.
std::vector<const SummaryRow*> matrix_rows(const ReportData& data) {
  std::vector<const SummaryRow*> rows;
  for (const std::string& method : data.summary.methods) {
    for (const std::string& budget : data.summary.budgets) {
      const auto found = std::find_if(
          data.summary.rows.begin(), data.summary.rows.end(),
          [&](const SummaryRow& row) { return row.method == method && row.budget == budget; });
      if (found != data.summary.rows.end()) rows.push_back(&*found);
    }
  }
  return rows;
}

std::string matrix_entry(const ReportData& data, const SceneView& scene, const SummaryRow& method) {
  const std::optional<std::size_t> index = find_row(scene, method);
  return index ? matrix_cell(data, scene, *index) : "<td class=\"none\">–</td>\n";
}

std::string matrix_title(const std::string& name) {
  return fmt::format("<th title=\"sort by total time\">{}</th>", escape(name));
}

std::string matrix_row_title(const std::string& name) {
  return fmt::format("<tr><th scope=\"row\">{}</th>\n", escape(name));
}

/// Few methods stand side by side, a row per scene; many of them below each other.
std::string matrix(const ReportData& data) {
  constexpr std::size_t kMostColumns = 6;
  const std::vector<const SummaryRow*> methods = matrix_rows(data);
  const bool has_method_columns = methods.size() <= kMostColumns;
  std::string head = has_method_columns ? "<th>scene</th>" : "<th>method</th>";
  std::string body;
  if (has_method_columns) {
    for (const SummaryRow* method : methods) head += matrix_title(row_label(data, *method));
    for (const SceneView& scene : data.scenes) {
      body += matrix_row_title(scene.name);
      for (const SummaryRow* method : methods) body += matrix_entry(data, scene, *method);
      body += "</tr>\n";
    }
  } else {
    for (const SceneView& scene : data.scenes) head += matrix_title(scene.name);
    for (const SummaryRow* method : methods) {
      body += matrix_row_title(row_label(data, *method));
      for (const SceneView& scene : data.scenes) body += matrix_entry(data, scene, *method);
      body += "</tr>\n";
    }
  }
  return "<div class=\"scroll\"><table id=\"matrix\" class=\"sortable matrix\"><thead><tr>" + head +
         "</tr></thead><tbody>\n" + body + "</tbody></table></div>\n";
}

std::string legend_of_all(const ReportData& data) {
  std::vector<const RenderRecord*> records;
  for (const SummaryRow& row : data.summary.rows) {
    if (row.typical) records.push_back(&data.run.cells[*row.typical].render);
  }
  return records.empty() ? "" : stage_legend(records);
}

}  // namespace

std::string overview_section(const ReportData& data) {
  std::string html = "<section id=\"overview\"><h2>Overview</h2>\n";
  if (data.summary.rows.empty())
    return html + "<p class=\"note\">no cell has ended yet</p></section>\n";
  html +=
      "<p class=\"note\"><b>own</b>: error against the light transport the method claims. "
      "<b>full</b>: against all light, what the viewer misses. Time: median; " +
      interval_note(data.summary) +
      ". Bar: shares of the total time. Colour of a score: its rank in the scene, "
      "<span class=\"rank-0\">best</span> <span class=\"rank-1\">&nbsp;</span> "
      "<span class=\"rank-2\">&nbsp;</span> <span class=\"rank-3\">&nbsp;</span> "
      "<span class=\"rank-4\">worst</span>; none for a score that lacks seeds.</p>\n";
  html += legend_of_all(data) + "<div id=\"matrix-filter\"></div>\n" + matrix(data);
  html += "<h3>All numbers</h3>\n" + html_table(summary_table(data.summary), "numbers");
  return html + "</section>\n";
}

}  // namespace results::html_report
