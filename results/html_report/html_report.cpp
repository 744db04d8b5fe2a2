#include "results/html_report/html_report.h"

#include "results/html_report/claims_section.h"
#include "results/html_report/color_bar.h"
#include "results/html_report/page_frame.h"
#include "results/html_report/report_data.h"
#include "results/html_report/sections.h"

#include <nlohmann/json.hpp>

namespace results::html_report {

namespace {

std::string page_title(const Run& run) {
  return run.folder.parent_path().filename().string() + " · " + run.folder.filename().string();
}

/// What the run says of the claims that it was made for; "" if there are none.
std::string claims_of(const Run& run) {
  const auto list = run.info->find("claims");
  if (list == run.info->end() || list->empty()) return "";
  return claims_section(claims::evaluate(claims::claims_from_json(*list), RunValues(run)));
}

}  // namespace

std::string html_report(const Run& run) {
  const ReportData data = collect_report_data(run);
  std::string body = color_bar_gradient() + header_section(data) + "<main>\n";
  body += overview_section(data) + claims_of(run);
  for (const SceneView& scene : data.scenes) body += scene_section(data, scene);
  body += search_section(data) + failure_section(data) + provenance_section(data) + "</main>\n";
  return page_frame(page_title(run), body);
}

std::filesystem::path write_report(const Run& run) {
  return write_page(run.folder, html_report(run));
}

}  // namespace results::html_report
