#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "metrics/metric_list.h"
#include "perception/base/atomic_file.h"
#include "perception/base/units.h"
#include "results/html_report/html_text.h"
#include "results/html_report/json_text.h"
#include "results/html_report/sections.h"

namespace results::html_report {

using nlohmann::ordered_json;

namespace {

std::string row(const std::vector<std::string>& cells) {
  std::string html = "<tr>";
  for (const std::string& cell : cells) html += "<td>" + cell + "</td>";
  return html + "</tr>\n";
}

std::string table(const std::vector<std::string>& titles, const std::string& rows) {
  std::string head;
  for (const std::string& title : titles) head += "<th>" + title + "</th>";
  return "<div class=\"scroll\"><table class=\"words\"><thead><tr>" + head +
         "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string parameters_text(const ParameterValues& parameters) {
  ordered_json json = ordered_json::object();
  for (const auto& [name, value] : parameters) json[name] = base::to_json(value);
  return text_of(json);
}

std::string methods(const ReportData& data) {
  std::string rows;
  std::set<std::string> seen;
  for (const std::string& method : data.summary.methods) {
    for (const CellRecord& cell : data.run.cells) {
      if (cell.method != method || !seen.insert(method).second) continue;
      const RenderRecord& render = cell.render;
      std::string claims = render.transport;
      if (render.part != "all") claims += ", " + render.part;
      if (render.geometry_clamp) {
        claims += ", clamp " + base::format_significant(*render.geometry_clamp, 3) + " /m²";
      }
      rows += row({escape(method), escape(render.renderer), escape(render.preset), escape(claims),
                   escape(render.device), std::to_string(render.threads),
                   escape(parameters_text(render.parameters))});
    }
  }
  if (rows.empty()) return "";
  return "<h3>Methods</h3>\n" +
         table({"method", "renderer", "preset", "claims", "device", "threads", "parameters"}, rows);
}

std::string metrics_table(const ReportData& data) {
  std::string rows;
  for (const std::string& metric : data.summary.metrics) {
    const metrics::MetricInfo* info = metric_info_of(metric);
    if (info == nullptr) {
      rows += row({escape(metric), "unknown to this build", "", "", "", "", ""});
      continue;
    }
    std::string steers;
    for (const std::string& renderer : info->shares_model_with) {
      steers += (steers.empty() ? "" : ", ") + renderer;
    }
    rows += row({escape(metric), escape(info->summary), escape(info->unit),
                 info->better == metrics::Better::lower ? "lower" : "higher", escape(info->input),
                 fmt::format("{}", info->version), escape(steers), escape(info->source)});
  }
  if (rows.empty()) return "";
  return "<h3>Metrics</h3>\n" + table({"metric", "what", "unit", "better", "input", "version",
                                       "not independent of", "source"},
                                      rows);
}

std::string reference_rows(const ReportData& data) {
  std::string rows;
  std::set<std::string> seen;
  for (const SceneView& scene : data.scenes) {
    for (const ReferenceView& reference : scene.references) {
      if (!seen.insert(reference.hash).second) continue;
      const auto file = data.run.folder / "../../../references" / reference.hash / "reference.json";
      std::string about = "not found";
      std::error_code error;
      if (std::filesystem::exists(file, error)) {
        about = text_of(ordered_json::parse(base::read_text_file(file), nullptr, false));
      }
      rows += row({escape(scene.name), escape(reference.label),
                   "<code>" + escape(reference.hash) + "</code>", escape(about)});
    }
  }
  return rows;
}

std::string references(const ReportData& data) {
  const std::string rows = reference_rows(data);
  if (rows.empty()) return "";
  return "<h3>References</h3>\n" + table({"scene", "light", "hash", "about"}, rows);
}

std::string machine(const ReportData& data) {
  const auto environment = data.run.info->find("environment");
  if (environment == data.run.info->end() || !environment->is_object()) return "";
  std::string rows;
  for (const auto& [key, value] : environment->items()) {
    const bool is_memory = key == "memory_bytes" && value.is_number();
    const std::string text = is_memory ? base::format_bytes(value.get<double>()) : text_of(value);
    rows += row({escape(key), escape(text.empty() ? "unknown" : text)});
  }
  return "<h3>Machine and build</h3>\n" + table({"", ""}, rows);
}

std::string run_facts(const ReportData& data) {
  std::string html;
  const std::string command = text_at(*data.run.info, {"command"});
  if (!command.empty()) html += fmt::format("<h3>Command</h3>\n<pre>{}</pre>\n", escape(command));
  if (!data.run.resolved_suite.empty()) {
    html += fmt::format(
        "<h3>Suite</h3>\n<details><summary>suite.resolved.yaml: every default "
        "written out</summary><pre>{}</pre></details>\n",
        escape(data.run.resolved_suite));
  }
  html += fmt::format(
      "<p class=\"note\">Record schema {}. Files of this run: run.json, "
      "suite.resolved.yaml, cells.jsonl ({} repetitions), metrics.jsonl ({} scores)."
      "</p>\n",
      kSchemaVersion, data.run.cells.size(), data.run.metrics.size());
  return html;
}

}  // namespace

std::string provenance_section(const ReportData& data) {
  return "<section id=\"provenance\"><h2>Provenance</h2>\n" + methods(data) + metrics_table(data) +
         references(data) + machine(data) + run_facts(data) + "</section>\n";
}

}  // namespace results::html_report
