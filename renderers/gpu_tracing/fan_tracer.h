#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "renderers/contract/stage_timer.h"
#include "renderers/gpu_tracing/gpu_bvh.h"
#include "renderers/opengl/buffer.h"

namespace renderers::gpu_tracing {

/// Targets of one fan.
inline constexpr std::size_t kFanTargets = 16;

/// Rays from one point to some of 16 targets in a row, std430 (`Fan` of
/// shaders/trace_fans.comp.glsl).
struct Fan {
  std::array<float, 3> origin{};   ///< m, world space
  std::uint32_t first_target = 0;  ///< into the table of targets
  std::uint32_t asked = 0;         ///< bit k: a ray to target first_target + k
};

/// Shadow rays on the device, in lists: what a technique wants to know at once.
class FanTracer {
 public:
  explicit FanTracer(std::shared_ptr<opengl::Context> context);

  /// @param targets  xyz: a point (m, world space), w: which share of the way is asked about; or
  ///   xyz: a direction, w: infinity
  void set_targets(std::span<const glm::vec4> targets);

  /// Which of the asked targets are hidden, a bit each, per fan. Stages `upload`, `rays` and
  /// `download` under whatever stage is open.
  /// @throws base::DeviceError if the device fails
  std::vector<std::uint32_t> occluded(const GpuBvh& bvh, std::span<const Fan> fans,
                                      StageTimer& timer);

  /// A ray's way through so many boxes is one dispatch. At most kMostBoxes, for tests fewer.
  void limit_boxes(std::uint32_t most_boxes);

  /// Boxes that a ray visits in one dispatch, if need be: Mesa's software driver ends an
  /// invocation's loops without a word after 65,535 turns of all together, and every box may hold
  /// a leaf of four triangles.
  static constexpr std::uint32_t kMostBoxes = 8192;
  /// Fans of one dispatch; more are traced in turn.
  static constexpr std::size_t kMostFans = std::size_t{1} << 17;

 private:
  void trace(const GpuBvh& bvh, std::uint32_t fan_count, StageTimer& timer);

  std::shared_ptr<opengl::Context> context_;
  opengl::Buffer fans_;
  opengl::Buffer targets_;
  opengl::Buffer occluded_;
  opengl::Buffer progress_;
  opengl::Buffer unfinished_;
  std::uint32_t most_boxes_ = kMostBoxes;
};

}  // namespace renderers::gpu_tracing
