#pragma once

#include <cstdint>
#include <string_view>

#include "renderers/contract/stage_timer.h"
#include "renderers/opengl/context.h"

namespace renderers::opengl {

/// A stage of work on the device: waits for the device at both ends, so that its wall time is its
/// own. Device time is read from 64-bit timer queries on hardware (clock gpu_query); a software
/// driver's queries are wrong for raster passes, there it is the wall time up to the end of
/// glFinish (clock finish).
///
///     const GpuStage stage(*context, timer, "gather");
class GpuStage {
 public:
  GpuStage(Context& context, StageTimer& timer, std::string_view name);
  ~GpuStage();
  GpuStage(const GpuStage&) = delete;
  GpuStage& operator=(const GpuStage&) = delete;
  void add_bytes(std::int64_t cpu, std::int64_t gpu = 0) { stage_.add_bytes(cpu, gpu); }

 private:
  Context& context_;
  StageTimer::Stage stage_;
  std::uint32_t queries_[2] = {0, 0};  ///< timestamps of start and end; stages may nest
  double start_s_ = 0.0;
};

}  // namespace renderers::opengl
