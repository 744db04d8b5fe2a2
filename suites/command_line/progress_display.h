#pragma once

#include <string>

#include "suites/command_line/console.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

/// "[#####-----]  12/24  horse pt8 64spp s1  12.1 s, 14.0 s left", cut to a width in columns.
std::string progress_bar(const Progress& progress, int columns);

/// "[12/24] horse pt8 64spp s1 (12.1 s, 14.0 s left)".
std::string progress_line(const Progress& progress);

/// Shows what is going on: a bar that renews itself on a terminal, else plain lines, at most one a
/// second, and one every ten seconds if nothing is finished.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(Console& console) : console_(console) {}
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const Progress& progress);

 private:
  bool is_due(double since_s, bool is_new, bool is_complete) const;

  Console& console_;
  bool has_shown_ = false;
  std::size_t shown_done_ = 0;
  std::string shown_activity_;
  double shown_at_s_ = 0.0;
};

}  // namespace suites::command_line
