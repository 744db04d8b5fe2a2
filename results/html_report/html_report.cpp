#include "results/html_report/html_report.h"

#include <algorithm>

#include "perception/base/child_process.h"
#include "results/gates/baseline.h"
#include "results/html_report/claims_section.h"
#include "results/html_report/color_bar.h"
#include "results/html_report/gates_section.h"
#include "results/html_report/page_frame.h"
#include "results/html_report/report_data.h"
#include "results/html_report/sections.h"
#include "results/html_report/viewer_manifest.h"
#include "results/run_files.h"

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

std::string page_of(const Run& run, FloatStore& store) {
  const ReportData data = collect_report_data(run, store);
  std::string body = color_bar_gradient() + header_section(data) + "<main>\n";
  body += overview_section(data) + gates_section(data.gates) + claims_of(run);
  for (const SceneView& scene : data.scenes) body += scene_section(data, scene);
  body += search_section(data) + failure_section(data) + provenance_section(data) + "</main>\n";
  body += viewer_manifest(data);
  return page_frame(page_title(run), body, store.is_split() ? Files::beside : Files::none,
                    store.elements());
}

}  // namespace

std::string html_report(const Run& run) {
  FloatStore store(Split::never, {});
  return page_of(run, store);
}

ReportFiles write_report(const Run& run, const ReportOptions& options) {
  require_no_links(run.folder);
  FloatStore store(options.split, run.folder / "report", options.split_above_bytes);
  const std::string html = page_of(run, store);
  return {write_page(run.folder, html), store.is_split(), store.bytes()};
}

std::filesystem::path report_file(const Run& run) { return page_file(run.folder); }

bool is_report_current(const Run& run) {
  std::error_code error;
  const auto written = std::filesystem::last_write_time(report_file(run), error);
  if (error) return false;
  const std::filesystem::path sources[] = {
      run.folder / "run.json",       run.folder / "cells.jsonl",
      run.folder / "metrics.jsonl",  run.folder / "convergence.jsonl",
      run.folder / "searches.jsonl", gates::baseline_file(results_root_of(run.folder), run),
      base::this_program()};
  return std::ranges::none_of(sources, [&](const std::filesystem::path& source) {
    const auto changed = std::filesystem::last_write_time(source, error);
    return !error && changed > written;
  });
}

}  // namespace results::html_report
