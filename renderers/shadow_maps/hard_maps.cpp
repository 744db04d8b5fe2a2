#include "renderers/shadow_maps/hard_maps.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <utility>

#include "renderers/opengl/program.h"
#include "renderers/shadow_maps/shader_files.h"

namespace renderers::shadow_maps {

namespace {

constexpr int kLocalSize = 64;
constexpr int kLayersPerThread = 16;
/// Work groups that walk the queue, whose length is known on the device only.
constexpr std::uint32_t kBoundGroups = 64;
constexpr std::uint32_t kLargeGroups = 4096;
constexpr std::uint32_t kOriginBinding = 3;
constexpr std::uint32_t kSphereBinding = 4;
constexpr std::uint32_t kQueueBinding = 5;

/// `LargePairs` of shaders/map_queue.glsl.
struct QueueHeader {
  std::uint32_t large_pairs_found = 0;
  std::uint32_t small_pairs = 0;
  std::uint32_t texels_small = 0;
  std::uint32_t texels_large = 0;
};
constexpr std::size_t kQueuedPair_bytes = 16;

opengl::ProgramSource source_of(const std::string& pass, bool counts_work) {
  opengl::ProgramSource source{shader_files(),
                               {"renderers/shadow_maps/shaders/" + pass + ".comp.glsl"}};
  if (counts_work) source.defines.emplace_back("COUNT_WORK", "1");
  return source;
}

}  // namespace

HardMaps::HardMaps(std::shared_ptr<opengl::Context> context, const HardMapSettings& settings)
    : context_(std::move(context)), settings_(settings) {
  const auto capacity = static_cast<std::size_t>(settings_.queue_capacity);
  queue_ = opengl::Buffer(context_, sizeof(QueueHeader) + capacity * kQueuedPair_bytes);
}

opengl::Program& HardMaps::bound_program(const char* pass, const HemisphereMaps& maps,
                                         const opengl::GpuScene& scene, const MapOrigins& origins) {
  opengl::Program& program = context_->program(source_of(pass, settings_.counts_work));
  program.storage(0, scene.triangles());
  program.storage(kOriginBinding, *origins.buffer);
  program.storage(kSphereBinding, spheres_.spheres());
  program.storage(kQueueBinding, queue_);
  program.image(0, maps.distances(), opengl::Access::read_write);
  program.set("size_px", maps.size_px());
  program.set("origin_stride", origins.stride);
  program.set("near_m", maps.near_m());
  program.set("queue_capacity", settings_.queue_capacity);
  return program;
}

void HardMaps::fill(HemisphereMaps& maps, const opengl::GpuScene& scene, const MapOrigins& origins,
                    int first, int count) {
  assert(count <= maps.layers());
  maps.clear();
  maps.set_near_m(settings_.near_share * scene.bounds().diagonal_m());
  const int triangles = scene.triangle_count();
  pairs_ = std::int64_t{triangles} * count;
  queue_.write<QueueHeader>(std::array{QueueHeader{}});
  if (pairs_ == 0) return;

  spheres_.load(scene);
  opengl::Program& pairs = bound_program("hard_map_pairs", maps, scene, origins);
  pairs.set("triangle_count", triangles);
  pairs.set("first_origin", first);
  pairs.set("layer_count", count);
  pairs.set("layers_per_thread", kLayersPerThread);
  pairs.set("direct_texels", settings_.direct_texels);
  pairs.dispatch(opengl::groups_for(triangles, kLocalSize),
                 opengl::groups_for(count, kLayersPerThread));

  opengl::Program& bounds = bound_program("hard_map_bounds", maps, scene, origins);
  bounds.set("first_origin", first);
  bounds.dispatch(kBoundGroups);
  opengl::Program& large = bound_program("hard_map_large", maps, scene, origins);
  large.set("first_origin", first);
  large.dispatch(kLargeGroups);
  context_->check("drawing shadow maps");
}

HardMapWork HardMaps::work() const {
  const QueueHeader header = queue_.read<QueueHeader>(1).front();
  HardMapWork work;
  work.pairs = pairs_;
  work.direct_pairs = header.small_pairs;
  work.queued_pairs = std::min<std::int64_t>(header.large_pairs_found, settings_.queue_capacity);
  work.overflow_pairs = header.large_pairs_found - work.queued_pairs;
  work.texels_tested = std::uint32_t{header.texels_small + header.texels_large};
  return work;
}

std::int64_t HardMaps::memory_bytes() const {
  return spheres_.memory_bytes() + static_cast<std::int64_t>(queue_.size_bytes());
}

}  // namespace renderers::shadow_maps
