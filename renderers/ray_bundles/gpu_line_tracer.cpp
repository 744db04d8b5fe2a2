#include "renderers/ray_bundles/gpu_line_tracer.h"

#include <cassert>
#include <utility>

#include "renderers/ray_bundles/gpu_dispatch.h"

namespace renderers::ray_bundles {

GpuLineTracer::GpuLineTracer(std::shared_ptr<opengl::Context> context,
                             const gpu_tracing::TriangleBvh& bvh, StageTimer& timer)
    : context_(std::move(context)), bvh_(context_), unfinished_(context_, sizeof(std::uint32_t)) {
  bvh_.load(bvh, timer);
}

void GpuLineTracer::limit_boxes(std::uint32_t most_boxes) {
  assert(most_boxes >= 1 && most_boxes <= kMostBoxes);
  most_boxes_ = most_boxes;
}

void GpuLineTracer::count(const BundleFrame& frame, const LineRows& rows,
                          const opengl::Buffer& counts) {
  opengl::Program& program = compute_program(*context_, "trace_lines");
  program.storage(2, counts);
  trace(program, frame, rows);
}

void GpuLineTracer::fill(const BundleFrame& frame, const LineRows& rows,
                         const opengl::Buffer& counts, const opengl::Buffer& starts,
                         const opengl::Buffer& words) {
  opengl::Program& program = compute_program(*context_, "trace_lines", {{"FILL", "1"}});
  program.storage(2, counts);
  program.storage(3, starts);
  program.storage(4, words);
  trace(program, frame, rows);
}

void GpuLineTracer::trace(opengl::Program& program, const BundleFrame& frame,
                          const LineRows& rows) {
  const std::size_t lines = line_count(frame, rows);
  progress_.reserve(context_, lines * sizeof(std::uint32_t));
  progress_.fill(0);
  bvh_.bind(program);
  program.storage(0, unfinished_);
  program.storage(1, progress_);
  set_frame(program, frame);
  program.set("line_count", static_cast<std::uint32_t>(lines));
  program.set("most_boxes", most_boxes_);
  program.set("width_px", frame.width_px);
  program.set("first_row", rows.begin);
  program.set("line_m", frame.line_m());
  // Every turn brings a line to a later node, so that this ends. A line cannot visit more boxes
  // than there are.
  const bool is_one_turn = bvh_.node_count() <= most_boxes_;
  do {
    unfinished_.fill(0);
    dispatch_items(program, static_cast<std::int64_t>(lines));
  } while (!is_one_turn && unfinished_.read<std::uint32_t>(1).front() > 0);
}

std::int64_t GpuLineTracer::memory_bytes() const {
  return bvh_.memory_bytes() + static_cast<std::int64_t>(progress_.size_bytes());
}

}  // namespace renderers::ray_bundles
