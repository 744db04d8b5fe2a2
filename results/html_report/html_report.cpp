#include "results/html_report/html_report.h"

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "results/html_report/color_bar.h"
#include "results/html_report/html_text.h"
#include "results/html_report/page_assets.h"
#include "results/html_report/report_data.h"
#include "results/html_report/sections.h"

namespace results::html_report {

namespace {

/// The policy makes "offline" a fact: the page can load nothing that is not inside it.
constexpr const char* kHead =
    "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
    "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";

std::string page_title(const Run& run) {
  return run.folder.parent_path().filename().string() + " · " + run.folder.filename().string();
}

}  // namespace

std::string html_report(const Run& run) {
  const ReportData data = collect_report_data(run);
  std::string html = kHead;
  html += fmt::format("<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
                      escape(page_title(run)), style_sheet());
  html += color_bar_gradient() + header_section(data) + "<main>\n" + overview_section(data);
  for (const SceneView& scene : data.scenes) html += scene_section(data, scene);
  html += failure_section(data) + provenance_section(data) + "</main>\n";
  html += fmt::format("<script>\n{}</script>\n</body>\n</html>\n", script());
  return html;
}

std::filesystem::path write_report(const Run& run) {
  std::filesystem::path path = run.folder / "report" / "index.html";
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  base::write_text_file(path, html_report(run));
  return path;
}

}  // namespace results::html_report
