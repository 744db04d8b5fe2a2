#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "renderers/contract/stage_timer.h"
#include "renderers/gpu_tracing/gpu_bvh.h"
#include "renderers/gpu_tracing/triangle_bvh.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/ray_bundles/bundle_frame.h"

namespace renderers::ray_bundles {

/// Rows of a bundle's lines that are made at once.
struct LineRows {
  int begin = 0;
  int end = 0;
  int count() const { return end - begin; }
};

inline std::size_t line_count(const BundleFrame& frame, const LineRows& rows) {
  return static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(rows.count());
}

/// Crossings of a bundle's lines by rays on the device: shaders/trace_lines.comp.glsl. Every hit
/// of a line is met once, wherever the walk is interrupted.
class GpuLineTracer {
 public:
  /// @param bvh  of triangles that `BvhTriangle::triangle` numbers as the words of the lists do.
  ///             Stage `upload` under whatever stage is open
  /// @throws UnsupportedError if it does not fit the device's storage blocks
  GpuLineTracer(std::shared_ptr<opengl::Context> context, const gpu_tracing::TriangleBvh& bvh,
                StageTimer& timer);

  /// Adds the crossings of every line to its count.
  void count(const BundleFrame& frame, const LineRows& rows, const opengl::Buffer& counts);
  /// Writes them into the lists, in any order, and takes them from the counts.
  void fill(const BundleFrame& frame, const LineRows& rows, const opengl::Buffer& counts,
            const opengl::Buffer& starts, const opengl::Buffer& words);

  /// A line's way through so many boxes is one dispatch. At most kMostBoxes, for tests fewer.
  void limit_boxes(std::uint32_t most_boxes);
  std::int64_t memory_bytes() const;

  /// Boxes that a line visits in one dispatch, if need be: see `FanTracer::kMostBoxes`.
  static constexpr std::uint32_t kMostBoxes = 8192;

 private:
  void trace(opengl::Program& program, const BundleFrame& frame, const LineRows& rows);

  std::shared_ptr<opengl::Context> context_;
  gpu_tracing::GpuBvh bvh_;
  opengl::Buffer progress_;
  opengl::Buffer unfinished_;
  std::uint32_t most_boxes_ = kMostBoxes;
};

}  // namespace renderers::ray_bundles
