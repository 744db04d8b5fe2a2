#include <deque>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/html_report/html_text.h"
#include "results/html_report/json_text.h"
#include "results/html_report/sections.h"

namespace results::html_report {

namespace {

constexpr std::size_t kLogLines = 40;

/// The last lines of a text file; "" if it is absent or empty.
std::string tail_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::deque<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    lines.push_back(line);
    if (lines.size() > kLogLines) lines.pop_front();
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string log_excerpt(const ReportData& data, const CellRecord& cell, const char* name) {
  const std::string text = tail_of(data.run.folder / "images" / cell.cell / name);
  if (text.empty()) return "";
  return fmt::format("<details><summary>{}, last lines</summary><pre>{}</pre></details>\n", name,
                     escape(text));
}

std::string failure(const ReportData& data, const CellRecord& cell) {
  const bool was_run =
      cell.render.status != Status::unsupported && cell.render.status != Status::skipped;
  std::string html = fmt::format(
      "<article class=\"failure\"><h4><span class=\"status{}\">{}</span> {} · {} · {}</h4>\n"
      "<p>{}</p>\n<p class=\"note\">cell {}, repetition {}, frame {}, {}</p>\n",
      was_run ? " failed" : "", to_string(cell.render.status), escape(cell.scene),
      escape(cell.method), escape(cell.budget),
      escape(cell.render.reason.value_or("no reason was recorded")), escape(cell.cell),
      cell.repetition, cell.render.frame, escape(cell.started_utc));
  if (was_run) {
    html += log_excerpt(data, cell, "stderr.log") + log_excerpt(data, cell, "stdout.log");
  }
  return html + "</article>\n";
}

/// References that could not be made: without them there are no scores.
std::string reference_failures(const ReportData& data) {
  std::string html;
  const auto references = data.run.info->find("references");
  if (references == data.run.info->end() || !references->is_array()) return html;
  for (const nlohmann::ordered_json& entry : *references) {
    const std::string reason = text_at(entry, {"reason"});
    if (reason.empty()) continue;
    html += fmt::format(
        "<article class=\"failure\"><h4><span class=\"status failed\">no reference</span> {} · "
        "{}</h4>\n<p>{}</p>\n</article>\n",
        escape(text_at(entry, {"scene"})), escape(text_at(entry, {"transport"})), escape(reason));
  }
  return html;
}

}  // namespace

std::string failure_section(const ReportData& data) {
  std::string failures = reference_failures(data);
  for (const CellRecord& cell : data.run.cells) {
    if (!is_success(cell.render.status)) failures += failure(data, cell);
  }
  if (failures.empty()) failures = "<p class=\"note\">none</p>\n";
  return "<section id=\"failures\"><h2>Failures</h2>\n" + failures + "</section>\n";
}

}  // namespace results::html_report
