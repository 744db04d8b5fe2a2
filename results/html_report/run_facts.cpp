#include "results/html_report/run_facts.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/units.h"
#include "results/html_report/html_text.h"
#include "results/html_report/json_text.h"

namespace results::html_report {

using nlohmann::ordered_json;

std::string fact(const char* name, const std::string& value) {
  if (value.empty()) return "";
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, escape(value));
}

std::string state_text(const ordered_json& info) {
  const std::string state = text_at(info, {"state"});
  if (state.empty() || state == "complete") return "";
  return state + ", as of " + text_at(info, {"updated_utc"});
}

std::string commit_text(const ordered_json& info) {
  std::string commit = text_at(info, {"environment", "commit"});
  constexpr std::size_t kShort = 12;
  if (commit.size() > kShort) commit.resize(kShort);
  const bool is_dirty = text_at(info, {"environment", "commit_dirty"}) == "true";
  return is_dirty ? commit + " with local changes" : commit;
}

std::string word_row(const std::vector<std::string>& cells) {
  std::string html = "<tr>";
  for (const std::string& cell : cells) html += "<td>" + cell + "</td>";
  return html + "</tr>\n";
}

std::string word_table(const std::vector<std::string>& titles, const std::string& rows) {
  std::string head;
  for (const std::string& title : titles) head += "<th>" + title + "</th>";
  return "<div class=\"scroll\"><table class=\"words\"><thead><tr>" + head +
         "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string machine_table(const ordered_json& info) {
  const auto environment = info.find("environment");
  if (environment == info.end() || !environment->is_object()) return "";
  std::string rows;
  for (const auto& [key, value] : environment->items()) {
    const bool is_memory = key == "memory_bytes" && value.is_number();
    const std::string text = is_memory ? base::format_bytes(value.get<double>()) : text_of(value);
    rows += word_row({escape(key), escape(text.empty() ? "unknown" : text)});
  }
  return "<h3>Machine and build</h3>\n" + word_table({"", ""}, rows);
}

std::string command_and_suite(const ordered_json& info, const std::string& resolved_suite) {
  std::string html;
  const std::string command = text_at(info, {"command"});
  if (!command.empty()) html += fmt::format("<h3>Command</h3>\n<pre>{}</pre>\n", escape(command));
  if (!resolved_suite.empty()) {
    html += fmt::format(
        "<h3>Suite</h3>\n<details><summary>suite.resolved.yaml: every default "
        "written out</summary><pre>{}</pre></details>\n",
        escape(resolved_suite));
  }
  return html;
}

}  // namespace results::html_report
