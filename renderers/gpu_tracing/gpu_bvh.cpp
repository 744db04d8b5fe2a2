#include "renderers/gpu_tracing/gpu_bvh.h"

#include <algorithm>
#include <span>

#include <fmt/core.h>

#include "renderers/opengl/gpu_stage.h"

namespace renderers::gpu_tracing {

namespace {

constexpr std::uint32_t kNodesBinding = 6;
constexpr std::uint32_t kTrianglesBinding = 7;

template <typename T>
std::size_t bytes_of(const std::vector<T>& elements) {
  return std::max<std::size_t>(1, elements.size()) * sizeof(T);
}

}  // namespace

void GpuBvh::load(const TriangleBvh& bvh, StageTimer& timer) {
  const auto limit_bytes = static_cast<std::size_t>(context_->limits().storage_block_bytes);
  const std::size_t largest_bytes = std::max(bytes_of(bvh.nodes), bytes_of(bvh.triangles));
  if (largest_bytes > limit_bytes) {
    throw UnsupportedError(fmt::format(
        "tracing {} triangles takes a buffer of {} bytes; {} allows {}; Embree has no such limit",
        bvh.triangles.size(), largest_bytes, context_->facts().renderer, limit_bytes));
  }
  opengl::GpuStage stage(*context_, timer, "upload");
  nodes_.reserve(context_, bytes_of(bvh.nodes));
  triangles_.reserve(context_, bytes_of(bvh.triangles));
  nodes_.write(std::span<const BvhNode>(bvh.nodes));
  triangles_.write(std::span<const BvhTriangle>(bvh.triangles));
  node_count_ = static_cast<std::uint32_t>(bvh.nodes.size());
  stage.add_bytes(0, memory_bytes());
}

void GpuBvh::bind(opengl::Program& program) const {
  program.storage(kNodesBinding, nodes_);
  program.storage(kTrianglesBinding, triangles_);
  program.set("bvh_node_count", node_count_);
}

std::int64_t GpuBvh::memory_bytes() const {
  return static_cast<std::int64_t>(nodes_.size_bytes() + triangles_.size_bytes());
}

}  // namespace renderers::gpu_tracing
