#include "tests/renderers/shadow_maps/map_bench.h"

#include <bit>
#include <limits>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "renderers/opengl/program.h"
#include "renderers/shadow_maps/hemisphere_projection.h"
#include "renderers/shadow_maps/scene_points.h"
#include "renderers/shadow_maps/shader_files.h"

namespace renderers::test {

namespace {

constexpr const char* kLookupPath = "lookup.comp.glsl";
constexpr const char* kLookupText = R"(
#include "renderers/shadow_maps/shaders/hemisphere_map.glsl"
layout(local_size_x = 64) in;
struct Origin { vec4 position; vec4 axis; };
struct Lookup { vec4 receiver; vec4 normal; };
layout(std430, binding = 3) readonly buffer Origins { Origin origins[]; };
layout(std430, binding = 4) readonly buffer Lookups { Lookup lookups[]; };
layout(std430, binding = 5) writeonly buffer Results { float results[]; };
uniform int lookup_count;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= lookup_count) return;
  uint layer = uint(lookups[i].receiver.w);
  results[i] = hemisphere_visibility(layer, origins[layer].position.xyz, origins[layer].axis.xyz,
                                     lookups[i].receiver.xyz, lookups[i].normal.xyz);
}
)";

opengl::Buffer buffer_of(const std::shared_ptr<opengl::Context>& context,
                         const std::vector<Origin>& origins) {
  return opengl::Buffer::of(context, std::span<const Origin>(origins));
}

}  // namespace

Origin origin_at(const glm::vec3& position, const glm::vec3& axis) {
  return {glm::vec4(position, 1.0F), glm::vec4(glm::normalize(axis), 0.0F)};
}

std::shared_ptr<opengl::Context> shared_context() {
  static const std::shared_ptr<opengl::Context> context = opengl::Context::create("auto");
  return context;
}

MapBench::MapBench(const scene::Scene& scene, std::shared_ptr<opengl::Context> context)
    : context_(std::move(context)), scene_(scene), rays_(scene_, timer_), gpu_(context_) {
  gpu_.load(scene_, timer_);
}

shadow_maps::HemisphereMaps MapBench::hard_maps(int size_px, const std::vector<Origin>& origins,
                                                const shadow_maps::HardMapSettings& settings,
                                                shadow_maps::HardMapWork* work) const {
  const int count = static_cast<int>(origins.size());
  shadow_maps::HemisphereMaps maps(context_, size_px, count);
  const opengl::Buffer buffer = buffer_of(context_, origins);
  shadow_maps::HardMaps filler(context_, settings);
  filler.fill(maps, gpu_, {&buffer, 2}, 0, count);
  if (work) *work = filler.work();
  return maps;
}

shadow_maps::HemisphereMaps MapBench::hemicube_maps(
    int size_px, const std::vector<Origin>& origins,
    const shadow_maps::HemicubeMapSettings& settings) const {
  const int count = static_cast<int>(origins.size());
  shadow_maps::HemisphereMaps maps(context_, size_px, count);
  const opengl::Buffer buffer = buffer_of(context_, origins);
  shadow_maps::HemicubeMaps filler(context_, settings);
  filler.fill(maps, gpu_, {&buffer, 2}, 0, count);
  return maps;
}

shadow_maps::HemisphereMaps MapBench::imperfect_maps(
    int size_px, const std::vector<Origin>& origins,
    const shadow_maps::ImperfectMapSettings& settings) const {
  const int count = static_cast<int>(origins.size());
  shadow_maps::HemisphereMaps maps(context_, size_px, count);
  const opengl::Buffer buffer = buffer_of(context_, origins);
  shadow_maps::ImperfectMaps filler(context_, settings);
  StageTimer timer;
  filler.load(scene_, timer);
  filler.fill(maps, {&buffer, 2}, 0, count);
  return maps;
}

shadow_maps::HemisphereMaps MapBench::vertex_maps(
    int size_px, const std::vector<Origin>& origins,
    const shadow_maps::VertexMapSettings& settings) const {
  const int count = static_cast<int>(origins.size());
  shadow_maps::HemisphereMaps maps(context_, size_px, count);
  const opengl::Buffer buffer = buffer_of(context_, origins);
  shadow_maps::VertexMaps filler(context_, settings);
  StageTimer timer;
  filler.load(scene_, timer);
  filler.fill(maps, gpu_, {&buffer, 2}, 0, count);
  return maps;
}

std::vector<Origin> origins_on_surfaces(const scene::Scene& scene, int count) {
  std::vector<Origin> origins;
  for (const auto& point : shadow_maps::scene_points(scene, 1, count)) {
    origins.push_back(origin_at(glm::vec3(point.position), glm::vec3(point.normal)));
  }
  return origins;
}

std::vector<float> visibilities(const shadow_maps::HemisphereMaps& maps,
                                const std::vector<Origin>& origins,
                                const std::vector<Lookup>& lookups,
                                const shadow_maps::LookupBias& bias) {
  const auto& context = maps.context();
  const auto kit = shadow_maps::shader_files();
  std::vector<opengl::ShaderFile> files(kit.begin(), kit.end());
  files.push_back({kLookupPath, kLookupText});
  opengl::Program program(*context, {files, {kLookupPath}});
  const opengl::Buffer origin_buffer = buffer_of(context, origins);
  const auto lookup_buffer = opengl::Buffer::of(context, std::span<const Lookup>(lookups));
  const opengl::Buffer results(context, lookups.size() * sizeof(float));
  program.storage(3, origin_buffer);
  program.storage(4, lookup_buffer);
  program.storage(5, results);
  program.set("lookup_count", static_cast<int>(lookups.size()));
  bind_hemisphere_maps(program, maps, bias);
  program.dispatch(opengl::groups_for(static_cast<std::int64_t>(lookups.size()), 64));
  context->check("looking up shadow maps");
  return results.read<float>(lookups.size());
}

float ray_distance(const MapBench& bench, const Origin& origin, float near_m,
                   const glm::dvec2& position) {
  const glm::dvec3 axis(origin.axis);
  const glm::dvec3 center = glm::dvec3(origin.position) + static_cast<double>(near_m) * axis;
  const glm::dvec3 direction =
      shadow_maps::hemisphere_frame(axis) * shadow_maps::hemisphere_direction(position);
  const ray_tracing::Ray ray{glm::vec3(center), glm::vec3(direction)};
  ray_tracing::Hit hit;
  if (!bench.rays().intersect(ray, hit)) return std::numeric_limits<float>::infinity();
  return hit.t * glm::length(ray.direction);
}

std::vector<float> distances_of(const shadow_maps::HemisphereMaps& maps, int layer) {
  std::vector<float> distances;
  for (const std::uint32_t word : maps.distances().read_words(layer)) {
    distances.push_back(std::bit_cast<float>(word));
  }
  return distances;
}

}  // namespace renderers::test
