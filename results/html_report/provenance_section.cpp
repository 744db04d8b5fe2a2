#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "metrics/metric_list.h"
#include "perception/base/atomic_file.h"
#include "perception/base/units.h"
#include "results/html_report/html_text.h"
#include "results/html_report/json_text.h"
#include "results/html_report/run_facts.h"
#include "results/html_report/sections.h"

namespace results::html_report {

using nlohmann::ordered_json;

namespace {

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
      rows += word_row({escape(method), escape(render.renderer), escape(render.preset),
                        escape(claims), escape(render.device), std::to_string(render.threads),
                        escape(parameters_text(render.parameters))});
    }
  }
  if (rows.empty()) return "";
  return "<h3>Methods</h3>\n" +
         word_table({"method", "renderer", "preset", "claims", "device", "threads", "parameters"},
                    rows);
}

std::string metrics_table(const ReportData& data) {
  std::string rows;
  for (const std::string& metric : data.summary.metrics) {
    const metrics::MetricDescription* info = metric_info_of(metric);
    if (info == nullptr) {
      rows += word_row({escape(metric), "unknown to this build", "", "", "", "", ""});
      continue;
    }
    std::string steers;
    for (const std::string& renderer : info->shares_model_with) {
      steers += (steers.empty() ? "" : ", ") + renderer;
    }
    rows +=
        word_row({escape(metric), escape(info->summary), escape(info->unit),
                  info->better == metrics::Better::lower ? "lower" : "higher", escape(info->input),
                  fmt::format("{}", info->version), escape(steers), escape(info->source)});
  }
  if (rows.empty()) return "";
  return "<h3>Metrics</h3>\n" + word_table({"metric", "what", "unit", "better", "input", "version",
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
      rows += word_row({escape(scene.name), escape(reference.label),
                        "<code>" + escape(reference.hash) + "</code>", escape(about)});
    }
  }
  return rows;
}

std::string references(const ReportData& data) {
  const std::string rows = reference_rows(data);
  if (rows.empty()) return "";
  return "<h3>References</h3>\n" + word_table({"scene", "light", "hash", "about"}, rows);
}

std::string files(const ReportData& data) {
  return fmt::format(
      "<p class=\"note\">Record schema {}. Files of this run: run.json, "
      "suite.resolved.yaml, cells.jsonl ({} repetitions), metrics.jsonl ({} scores)."
      "</p>\n",
      kSchemaVersion, data.run.cells.size(), data.run.metrics.size());
}

}  // namespace

std::string provenance_section(const ReportData& data) {
  return "<section id=\"provenance\"><h2>Provenance</h2>\n" + methods(data) + metrics_table(data) +
         references(data) + machine_table(*data.run.info) +
         command_and_suite(*data.run.info, data.run.resolved_suite) + files(data) + "</section>\n";
}

}  // namespace results::html_report
