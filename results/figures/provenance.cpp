#include "results/figures/provenance.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "results/html_report/json_text.h"

namespace results::figures {

Metadata provenance_of(const FigureSpec& figure, const Run& run) {
  const nlohmann::ordered_json& info = *run.info;
  const auto known = [&](std::initializer_list<const char*> keys) {
    const std::string text = html_report::text_at(info, keys);
    return text.empty() ? std::string("unknown") : text;
  };
  const std::string profile = html_report::text_at(info, {"profile"});
  return {{"Title", fmt::format("Figure {} ({}){}{}", figure.id, to_string(figure.kind),
                                figure.title.empty() ? "" : ": ", figure.title)},
          {"Subject", fmt::format("suite {}{}, run {}, {}", known({"suite"}),
                                  profile.empty() ? "" : ", profile " + profile, known({"run"}),
                                  known({"environment", "started_utc"}))},
          {"Creator", fmt::format("discern {}, commit {}", known({"environment", "version"}),
                                  known({"environment", "commit"}))},
          {"Keywords", fmt::format("machine {}, {}", known({"environment", "machine"}),
                                   known({"environment", "cpu"}))}};
}

std::vector<std::string> lines_of(const Metadata& provenance) {
  std::vector<std::string> lines;
  for (const auto& [name, text] : provenance) lines.push_back(text);
  return lines;
}

void stamp(const std::filesystem::path& file, const Metadata& provenance) {
  std::string bytes = base::read_text_file(file);
  const std::filesystem::path extension = file.extension();
  const bool is_stamped = extension == ".svg"   ? add_svg_metadata(bytes, provenance)
                          : extension == ".png" ? add_png_metadata(bytes, provenance)
                                                : add_pdf_metadata(bytes, provenance);
  if (!is_stamped) {
    throw base::InputError(
        fmt::format("{}: gnuplot wrote no {}", file.string(), extension.string().substr(1)));
  }
  base::write_text_file(file, bytes);
}

}  // namespace results::figures
