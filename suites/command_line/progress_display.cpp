#include "suites/command_line/progress_display.h"

#include <algorithm>
#include <ostream>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "suites/command_line/printable_text.h"

namespace suites::command_line {

namespace {

constexpr int kBarCells = 24;
constexpr double kLineInterval_s = 1.0;
constexpr double kSignOfLife_s = 10.0;
constexpr double kBarInterval_s = 0.1;
constexpr const char* kClearLine = "\r\x1b[K";

std::string time_text(const Progress& progress) {
  std::string text = base::format_duration(progress.elapsed_s);
  if (progress.remaining_s >= 0.0) {
    text += fmt::format(", {} left", base::format_duration(progress.remaining_s));
  }
  return text;
}

}  // namespace

std::string progress_bar(const Progress& progress, int columns) {
  const double fraction = progress.total == 0 ? 0.0
                                              : static_cast<double>(progress.done) /
                                                    static_cast<double>(progress.total);
  const int filled = std::clamp(static_cast<int>(fraction * kBarCells), 0, kBarCells);
  std::string text =
      fmt::format("[{}{}]  {}/{}  {}  {}", std::string(static_cast<std::size_t>(filled), '#'),
                  std::string(static_cast<std::size_t>(kBarCells - filled), '-'), progress.done,
                  progress.total, time_text(progress), progress.activity);
  // A line as wide as the terminal would wrap and could not be renewed.
  const auto limit = static_cast<std::size_t>(std::max(columns - 1, 1));
  if (text.size() > limit) text.resize(limit);
  return text;
}

std::string progress_line(const Progress& progress) {
  return fmt::format("[{}/{}] {} ({})", progress.done, progress.total, progress.activity,
                     time_text(progress));
}

void ProgressDisplay::show(const Progress& progress) {
  const bool is_new = progress.done != shown_done_ || progress.activity != shown_activity_;
  if (!is_due(progress.elapsed_s - shown_at_s_, is_new, progress.done == progress.total)) return;
  if (console_.err_is_terminal) {
    console_.err << kClearLine << printable(progress_bar(progress, console_.err_columns))
                 << std::flush;
  } else {
    console_.err << printable(progress_line(progress)) << std::endl;
  }
  has_shown_ = true;
  shown_done_ = progress.done;
  shown_activity_ = progress.activity;
  shown_at_s_ = progress.elapsed_s;
}

bool ProgressDisplay::is_due(double since_s, bool is_new, bool is_complete) const {
  if (!has_shown_ || (is_new && is_complete)) return true;
  if (console_.err_is_terminal) return since_s >= kBarInterval_s;
  return since_s >= (is_new ? kLineInterval_s : kSignOfLife_s);
}

ProgressDisplay::~ProgressDisplay() {
  if (has_shown_ && console_.err_is_terminal) console_.err << kClearLine << std::flush;
}

}  // namespace suites::command_line
