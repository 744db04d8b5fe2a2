#pragma once

#include <cstdint>
#include <memory>

#include "renderers/contract/stage_timer.h"
#include "renderers/gpu_tracing/triangle_bvh.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/program.h"

namespace renderers::gpu_tracing {

/// A hierarchy on the device, for shaders that include shaders/bvh.glsl.
class GpuBvh {
 public:
  explicit GpuBvh(std::shared_ptr<opengl::Context> context) : context_(std::move(context)) {}

  /// Replaces what it holds. Stage `upload` under whatever stage is open.
  /// @throws UnsupportedError if it does not fit into the device's storage blocks, naming
  ///   triangles, bytes and limit
  void load(const TriangleBvh& bvh, StageTimer& timer);

  /// Binds bindings 6 and 7 and sets the uniform of bvh.glsl.
  void bind(opengl::Program& program) const;

  std::uint32_t node_count() const { return node_count_; }
  std::int64_t memory_bytes() const;
  const std::shared_ptr<opengl::Context>& context() const { return context_; }

 private:
  std::shared_ptr<opengl::Context> context_;
  opengl::Buffer nodes_;
  opengl::Buffer triangles_;
  std::uint32_t node_count_ = 0;
};

}  // namespace renderers::gpu_tracing
