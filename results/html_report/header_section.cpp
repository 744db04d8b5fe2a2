#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/units.h"
#include "results/html_report/html_text.h"
#include "results/html_report/json_text.h"
#include "results/html_report/run_facts.h"
#include "results/html_report/sections.h"

namespace results::html_report {

using nlohmann::ordered_json;

namespace {

/// A number of the viewing conditions with three digits.
std::string viewing_number(const ordered_json& viewing, const char* key) {
  const auto value = viewing.find(key);
  if (value == viewing.end() || !value->is_number()) return "?";
  return base::format_significant(value->get<double>(), 3);
}

/// "67.0 pixels per degree, srgb, 200 cd/m² peak, ..."; "" before it is known.
std::string viewing_text(const ordered_json& info) {
  const auto viewing = info.find("viewing");
  if (viewing == info.end() || !viewing->is_object()) return "";
  const auto found = viewing->find("display");
  const ordered_json display = found == viewing->end() ? ordered_json::object() : *found;
  return fmt::format(
      "{} pixels per degree, {}, {} cd/m² peak, {} cd/m² black, {} lux, exposure {} EV",
      viewing_number(*viewing, "ppd"), text_at(display, {"transfer"}),
      viewing_number(display, "peak_cd_m2"), viewing_number(display, "black_cd_m2"),
      viewing_number(display, "ambient_lux"), viewing_number(*viewing, "exposure_ev"));
}

std::string counts(const ReportData& data) {
  const RunSummary& summary = data.summary;
  std::string html = fmt::format("<b class=\"ok\">{} ok</b>", summary.ok_cells);
  const auto add = [&](std::size_t count, const char* css, const char* name) {
    if (count > 0) html += fmt::format(" <b class=\"{}\">{} {}</b>", css, count, name);
  };
  add(summary.failed_cells, "failed", "failed");
  add(summary.skipped_cells, "skipped", "not run");
  add(summary.missing_cells, "skipped", "not yet");
  return html;
}

std::string navigation(const ReportData& data) {
  std::string links = "<a href=\"#overview\">Overview</a>";
  if (!data.gates.gates.empty()) links += "<a href=\"#gates\">Gates</a>";
  const auto claims = data.run.info->find("claims");
  if (claims != data.run.info->end() && !claims->empty()) {
    links += "<a href=\"#claims\">Claims</a>";
  }
  for (const SceneView& scene : data.scenes) {
    links += fmt::format("<a href=\"#{}\">{}</a>", scene.anchor, escape(scene.name));
  }
  if (!data.run.searches.empty()) links += "<a href=\"#searches\">Searched budgets</a>";
  links += "<a href=\"#failures\">Failures</a><a href=\"#provenance\">Provenance</a>";
  return "<nav>" + links + "</nav>\n";
}

std::string title_of(const ReportData& data) {
  const std::string suite = text_at(*data.run.info, {"suite"});
  return suite.empty() ? data.run.folder.parent_path().filename().string() : suite;
}

}  // namespace

std::string header_section(const ReportData& data) {
  const ordered_json& info = *data.run.info;
  std::string html = fmt::format("<header><h1>{}</h1>\n", escape(title_of(data)));
  const std::string summary = text_at(info, {"summary"});
  if (!summary.empty()) html += fmt::format("<p class=\"lead\">{}</p>\n", escape(summary));
  html += "<dl class=\"facts\">";
  html += fact("run", data.run.folder.filename().string());
  html += fact("started", text_at(info, {"environment", "started_utc"}));
  html += fact("state", state_text(info));
  html += fact("profile", text_at(info, {"profile"}));
  html += fact("machine", text_at(info, {"environment", "machine"}));
  html += fact("commit", commit_text(info));
  html += fact("viewing", viewing_text(info));
  html += "<div><dt>cells</dt><dd>" + counts(data) + "</dd></div></dl>\n";
  if (data.run.unreadable_lines > 0) {
    html += fmt::format(
        "<p class=\"warning\">{} cut lines of the result files were left out: a "
        "process was killed while it wrote.</p>\n",
        data.run.unreadable_lines);
  }
  return html + "</header>\n" + navigation(data);
}

}  // namespace results::html_report
