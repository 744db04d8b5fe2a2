#include "tests/headless_browser.h"

#include <regex>

namespace tests {

bool has_browser() {
  const auto result =
      base::run_command({"sh", "-c", "command -v chromium"}, std::chrono::seconds(10));
  return result.exit.code == 0;
}

base::CommandResult browse(const std::filesystem::path& page, const std::filesystem::path& profile,
                           const std::vector<std::string>& options) {
  std::vector<std::string> command{"chromium",
                                   "--headless",
                                   "--no-sandbox",
                                   "--disable-gpu",
                                   "--disable-quic",
                                   "--no-first-run",
                                   "--disable-background-networking",
                                   "--disable-component-update",
                                   "--disable-sync",
                                   "--enable-logging=stderr",
                                   "--v=0",
                                   "--user-data-dir=" + profile.string(),
                                   "--window-size=1400,2400"};
  command.insert(command.end(), options.begin(), options.end());
  command.push_back("file://" + page.string());
  return base::run_command(command, std::chrono::seconds(120));
}

std::string console_lines(const std::string& log) {
  const std::regex line("[^\n]*CONSOLE[^\n]*");
  std::string lines;
  for (std::sregex_iterator match(log.begin(), log.end(), line), end; match != end; ++match) {
    lines += match->str() + "\n";
  }
  return lines;
}

}  // namespace tests
