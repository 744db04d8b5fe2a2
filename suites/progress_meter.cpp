#include "suites/progress_meter.h"

#include <algorithm>

#include "renderers/contract/stage_timer.h"

namespace suites {
namespace {

/// Below this part of the work its speed is not known well enough to say when it ends.
constexpr double kMinKnownPart = 0.02;

}  // namespace

ProgressMeter::ProgressMeter(Report report)
    : report_(std::move(report)), start_s_(renderers::steady_seconds()) {}

void ProgressMeter::plan(std::size_t steps, double work) {
  progress_.total += steps;
  planned_work_ += work;
}

void ProgressMeter::begin_step(const std::string& activity, double work) {
  progress_.activity = activity;
  step_work_ = work;
  show();
}

void ProgressMeter::show(double fraction) {
  if (!report_) return;
  const double done = done_work_ + fraction * step_work_;
  progress_.elapsed_s = renderers::steady_seconds() - start_s_;
  const bool is_known = done > kMinKnownPart * planned_work_;
  const double left = std::max(0.0, planned_work_ - done);
  progress_.remaining_s = is_known ? progress_.elapsed_s * left / done : -1.0;
  report_(progress_);
}

void ProgressMeter::finish_step() {
  ++progress_.done;
  progress_.total = std::max(progress_.total, progress_.done);
  done_work_ += step_work_;
  step_work_ = 0.0;
  show();
}

}  // namespace suites
