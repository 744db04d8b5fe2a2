#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderers/contract/stage_timer.h"
#include "suites/measurement.h"

namespace suites {

/// Stores the images that a progressive renderer hands over; its time is taken out of the stages.
class CheckpointWriter {
 public:
  CheckpointWriter(const MeasureRequest& request, renderers::StageTimer& timer)
      : request_(request), timer_(timer) {}

  /// @param ready_s  wall time of prepare or update, its readback with it
  /// @param start_s  start of the render call, steady clock
  void start(double ready_s, double start_s) {
    ready_s_ = ready_s;
    start_s_ = start_s;
  }

  void store(const perception::Image& radiance, std::int64_t samples);

  double spent_s() const { return spent_s_; }
  std::vector<results::Checkpoint> take() { return std::move(checkpoints_); }
  const std::optional<std::string>& storage_error() const { return storage_error_; }

 private:
  const MeasureRequest& request_;
  renderers::StageTimer& timer_;
  std::vector<results::Checkpoint> checkpoints_;
  std::optional<std::string> storage_error_;
  double ready_s_ = 0.0;
  double start_s_ = 0.0;
  double spent_s_ = 0.0;
};

}  // namespace suites
