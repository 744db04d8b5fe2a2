#pragma once

#include <functional>
#include <string>

#include "suites/suite_runner.h"

namespace suites {

/// Counts steps and their work, and passes both on to the display with elapsed and remaining time.
///
/// Work is counted in pixels times samples: what a path tracer does is the yardstick, everything
/// else is set against it. The remaining time is the elapsed one, scaled by work.
class ProgressMeter {
 public:
  using Report = std::function<void(const Progress&)>;

  explicit ProgressMeter(Report report);

  /// Announces steps that are still to come.
  void plan(std::size_t steps, double work);
  void begin_step(const std::string& activity, double work);
  /// @param fraction  part of the current step that is done, in [0, 1]
  void show(double fraction = 0.0);
  void finish_step();

 private:
  Report report_;
  Progress progress_;
  double start_s_ = 0.0;
  double planned_work_ = 0.0;
  double done_work_ = 0.0;
  double step_work_ = 0.0;
};

}  // namespace suites
