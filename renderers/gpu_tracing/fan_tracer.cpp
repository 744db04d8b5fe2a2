#include "renderers/gpu_tracing/fan_tracer.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "renderers/gpu_tracing/shader_files.h"
#include "renderers/opengl/gpu_stage.h"
#include "renderers/opengl/program.h"

namespace renderers::gpu_tracing {

namespace {

constexpr std::int64_t kLocalSize = 64;  ///< of trace_fans.comp.glsl

static_assert(sizeof(Fan) == 20);

}  // namespace

FanTracer::FanTracer(std::shared_ptr<opengl::Context> context)
    : context_(std::move(context)), unfinished_(context_, sizeof(std::uint32_t)) {}

void FanTracer::set_targets(std::span<const glm::vec4> targets) {
  targets_.reserve(context_, std::max<std::size_t>(1, targets.size()) * sizeof(glm::vec4));
  targets_.write(targets);
}

void FanTracer::limit_boxes(std::uint32_t most_boxes) {
  assert(most_boxes >= 1 && most_boxes <= kMostBoxes);
  most_boxes_ = most_boxes;
}

std::vector<std::uint32_t> FanTracer::occluded(const GpuBvh& bvh, std::span<const Fan> fans,
                                               StageTimer& timer) {
  std::vector<std::uint32_t> bits;
  bits.reserve(fans.size());
  for (std::size_t begin = 0; begin < fans.size(); begin += kMostFans) {
    const auto part = fans.subspan(begin, std::min(kMostFans, fans.size() - begin));
    {
      opengl::GpuStage stage(*context_, timer, "upload");
      fans_.reserve(context_, part.size_bytes());
      fans_.write(part);
      stage.add_bytes(0, static_cast<std::int64_t>(part.size_bytes()));
    }
    trace(bvh, static_cast<std::uint32_t>(part.size()), timer);
    opengl::GpuStage stage(*context_, timer, "download");
    const auto found = occluded_.read<std::uint32_t>(part.size());
    stage.add_bytes(static_cast<std::int64_t>(found.size() * sizeof(std::uint32_t)));
    bits.insert(bits.end(), found.begin(), found.end());
  }
  return bits;
}

/// Traces the fans in `fans_` into `occluded_`.
void FanTracer::trace(const GpuBvh& bvh, std::uint32_t fan_count, StageTimer& timer) {
  const opengl::GpuStage stage(*context_, timer, "rays");
  occluded_.reserve(context_, fan_count * sizeof(std::uint32_t));
  progress_.reserve(context_, fan_count * kFanTargets * sizeof(std::uint32_t));
  occluded_.fill(0);
  progress_.fill(0);
  opengl::Program& program =
      context_->program({shader_files(), {"renderers/gpu_tracing/shaders/trace_fans.comp.glsl"}});
  bvh.bind(program);
  program.storage(0, fans_);
  program.storage(1, targets_);
  program.storage(2, occluded_);
  program.storage(3, progress_);
  program.storage(4, unfinished_);
  program.set("fan_count", fan_count);
  program.set("most_boxes", most_boxes_);
  const std::int64_t rays = std::int64_t{fan_count} * std::int64_t{kFanTargets};
  // Every turn brings a ray to a later node, so that this ends. A ray cannot visit more boxes than
  // there are.
  const bool is_one_turn = bvh.node_count() <= most_boxes_;
  do {
    unfinished_.fill(0);
    program.dispatch(opengl::groups_for(rays, kLocalSize));
  } while (!is_one_turn && unfinished_.read<std::uint32_t>(1).front() > 0);
  context_->check("tracing shadow rays");
}

}  // namespace renderers::gpu_tracing
