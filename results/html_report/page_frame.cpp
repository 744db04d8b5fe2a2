#include "results/html_report/page_frame.h"

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "results/html_report/html_text.h"
#include "results/html_report/page_assets.h"

namespace results::html_report {

std::string page_frame(const std::string& title, const std::string& body, Files files,
                       const std::string& data) {
  const char* beside = files == Files::beside ? " 'self' file:" : "";
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += fmt::format(
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src "
      "data:{0}; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'{0}\">\n",
      beside);
  html += fmt::format("<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n", escape(title),
                      style_sheet());
  html += body + fmt::format("<script>\n{}</script>\n", script());
  html += data;
  return html + "</body>\n</html>\n";
}

std::filesystem::path page_file(const std::filesystem::path& run_folder) {
  return run_folder / "report" / "index.html";
}

std::filesystem::path write_page(const std::filesystem::path& run_folder, const std::string& html) {
  std::filesystem::path path = page_file(run_folder);
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  base::write_text_file(path, html);
  return path;
}

}  // namespace results::html_report
