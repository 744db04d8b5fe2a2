#include "renderers/clustered_visibility/scatter_clusters.h"

#include <string>
#include <utility>

#include "renderers/clustered_visibility/shader_files.h"

namespace renderers::clustered_visibility {

namespace {

constexpr int kLocalSize = 64;  ///< of scatter_assign and scatter_move
constexpr std::uint32_t kLights = 3;
constexpr std::uint32_t kAssignments = 4;
constexpr std::uint32_t kCenters = 5;
constexpr std::uint32_t kSummary = 6;
constexpr std::uint32_t kState = 7;
constexpr std::size_t kStateBytes = 2 * sizeof(std::int32_t);

std::string path_of(const char* pass) {
  return std::string("renderers/clustered_visibility/shaders/") + pass + ".glsl";
}

}  // namespace

ScatterClusters::ScatterClusters(std::shared_ptr<opengl::Context> context, int clusters)
    : context_(std::move(context)),
      sums_(context_,
            {.format = opengl::TextureFormat::rgba32f, .width_px = clusters, .height_px = 2}),
      target_(context_, &sums_, nullptr),
      state_(context_, kStateBytes) {}

void ScatterClusters::run(const ScatterInput& input) {
  opengl::Program& assign = context_->program({shader_files(), {path_of("scatter_assign.comp")}});
  opengl::Program& scatter = context_->program(
      {shader_files(), {path_of("scatter_light.vert"), path_of("scatter_light.frag")}});
  opengl::Program& move = context_->program({shader_files(), {path_of("scatter_move.comp")}});
  state_.fill(0);
  for (int i = 0; i < input.iterations; ++i) {
    assign.storage(kLights, input.lights);
    assign.storage(kAssignments, input.assignments);
    assign.storage(kCenters, input.centers);
    assign.storage(kState, state_);
    assign.set("light_count", input.light_count);
    input.set_rule(assign);
    assign.dispatch(opengl::groups_for(input.light_count, kLocalSize));

    sums_.clear({0.0F, 0.0F, 0.0F, 0.0F});
    {
      const opengl::RasterPass pass(target_, opengl::DepthTest::none, 0, opengl::Blending::add);
      scatter.storage(kLights, input.lights);
      scatter.storage(kAssignments, input.assignments);
      scatter.set("columns", sums_.shape().width_px);
      scatter.set("bounds_min", input.bounds_min);
      scatter.draw_points(2 * input.light_count);
    }

    move.storage(kCenters, input.centers);
    move.storage(kSummary, input.summary);
    move.storage(kState, state_);
    move.sampler(0, sums_);
    move.set("is_first", i == 0 ? 1 : 0);
    move.set("bounds_min", input.bounds_min);
    input.set_rule(move);
    move.dispatch(1);
  }
}

std::int64_t ScatterClusters::memory_bytes() const {
  return opengl::size_bytes_of(sums_.shape()) + static_cast<std::int64_t>(state_.size_bytes());
}

}  // namespace renderers::clustered_visibility
