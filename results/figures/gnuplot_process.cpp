#include "results/figures/gnuplot_process.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include "perception/base/child_process.h"
#include "perception/base/errors.h"
#include "results/figures/gnuplot_text.h"

namespace results::figures {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::duration<double> kTimeLimit{60.0};

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::string gnuplot_program() {
  const char* chosen = std::getenv("DISCERN_GNUPLOT");
  if (chosen != nullptr && *chosen != '\0') {
    if (is_program(chosen)) return chosen;
    throw base::InputError(fmt::format(
        "$DISCERN_GNUPLOT is \"{}\", which is no program; figures need gnuplot: apt-get "
        "install gnuplot-nox",
        chosen));
  }
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (is_program(fs::path(folder) / "gnuplot")) return (fs::path(folder) / "gnuplot").string();
  }
  throw base::InputError(
      "figures need gnuplot, which is not on $PATH: apt-get install gnuplot-nox (or name the "
      "program in $DISCERN_GNUPLOT)");
}

void run_gnuplot(const fs::path& folder, const std::string& script, const std::string& formats) {
  // -d: no start-up files of the user; the script's paths are relative to its folder.
  const std::vector<std::string> arguments{gnuplot_program(),
                                           "-d",
                                           "-e",
                                           "cd " + gnuplot_plain_string(folder.string()),
                                           "-e",
                                           fmt::format("formats = '{}'", formats),
                                           script};
  const base::CommandResult result = base::run_command(arguments, kTimeLimit);
  const std::string what = (folder / script).string();
  if (result.timed_out) {
    throw base::InputError(
        fmt::format("{}: gnuplot took more than {} s and was ended", what, kTimeLimit.count()));
  }
  if (result.exit.code == 0 && result.exit.signal == 0) return;
  throw base::InputError(
      fmt::format("{}: gnuplot failed ({}): {}", what, result.exit.text(), result.stderr_text));
}

}  // namespace results::figures
