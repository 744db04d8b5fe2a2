#include "results/figures/provenance.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "results/figures/gnuplot_text.h"
#include "results/html_report/json_text.h"
#include "results/markup_text.h"

namespace results::figures {

namespace {

void stamp_svg(std::string& svg, const std::vector<std::string>& lines,
               const std::filesystem::path& file) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t end = begin == std::string::npos ? begin : svg.find('>', begin);
  if (end == std::string::npos) throw base::InputError(file.string() + ": no SVG");
  std::string metadata = "\n<metadata>";
  for (const std::string& line : lines) {
    metadata += "\n" + escape(gnuplot_comment(line));
  }
  svg.insert(end + 1, metadata + "\n</metadata>");
}

/// ISO 32000-1, Sec. 7.5.5: the last lines are `startxref`, the offset, and `%%EOF`.
void stamp_pdf(std::string& pdf, const std::vector<std::string>& lines,
               const std::filesystem::path& file) {
  const std::size_t end = pdf.rfind("startxref");
  if (!pdf.starts_with("%PDF-") || end == std::string::npos) {
    throw base::InputError(file.string() + ": no PDF");
  }
  const std::string last_lines = pdf.substr(end);
  for (const std::string& line : lines) pdf += "% " + gnuplot_comment(line) + "\n";
  pdf += last_lines;
}

}  // namespace

std::vector<std::string> provenance_lines(const FigureSpec& figure, const Run& run) {
  const nlohmann::ordered_json& info = *run.info;
  const auto known = [&](std::initializer_list<const char*> keys) {
    const std::string text = html_report::text_at(info, keys);
    return text.empty() ? std::string("unknown") : text;
  };
  return {fmt::format("Figure {} ({}){}{}", figure.id, to_string(figure.kind),
                      figure.title.empty() ? "" : ": ", figure.title),
          fmt::format("suite {}, run {}, {}", known({"suite"}), known({"run"}),
                      known({"environment", "started_utc"})),
          fmt::format("discern {}, commit {}", known({"environment", "version"}),
                      known({"environment", "commit"})),
          fmt::format("machine {}, {}", known({"environment", "machine"}),
                      known({"environment", "cpu"}))};
}

void stamp(const std::filesystem::path& file, const std::vector<std::string>& lines) {
  std::string bytes = base::read_text_file(file);
  if (file.extension() == ".svg") {
    stamp_svg(bytes, lines, file);
  } else {
    stamp_pdf(bytes, lines, file);
  }
  base::write_text_file(file, bytes);
}

}  // namespace results::figures
