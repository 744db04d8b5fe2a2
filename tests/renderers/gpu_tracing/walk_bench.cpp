#include "tests/renderers/gpu_tracing/walk_bench.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <glm/vec4.hpp>

#include "renderers/gpu_tracing/shader_files.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/program.h"

namespace renderers::test {

namespace {

constexpr std::uint32_t kMostListed = 64;
/// Per ray: occluded, number of hits, the hits.
constexpr std::size_t kWords = 2 + kMostListed;

constexpr opengl::ShaderFile kAllHits{"test/all_hits.comp.glsl",
                                      R"(#include "renderers/gpu_tracing/shaders/bvh.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Rays { vec4 rays[]; };
layout(std430, binding = 1) buffer Found { uint found[]; };
uniform uint ray_count;
uniform uint triangle_count;
const uint kWords = 66u;
uint base = 0u;
bool wants_all = false;
bool bvh_stops_at(BvhHit hit) {
  if (!wants_all) return true;
  uint count = found[base + 1u]++;
  if (count < kWords - 2u) found[base + 2u + count] = hit.triangle;
  return false;
}
bool try_all(BvhRay ray) {
  for (uint i = 0; i < triangle_count; ++i) {
    BvhHit hit;
    if (!bvh_meets(bvh_triangles[i].a, bvh_triangles[i].b, bvh_triangles[i].c, ray, hit)) continue;
    hit.triangle = bvh_triangles[i].triangle;
    if (bvh_stops_at(hit)) return true;
  }
  return false;
}
void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= ray_count) return;
  BvhRay ray = BvhRay(rays[2u * index].xyz, rays[2u * index + 1u].xyz, rays[2u * index].w);
  base = kWords * index;
  for (uint pass = 0; pass < 2u; ++pass) {
    wants_all = pass == 1u;
    uint node = 0;
#ifdef WITH_TREE
    bool is_stopped = bvh_walk(ray, bvh_node_count, node);
#else
    bool is_stopped = try_all(ray);
#endif
    if (is_stopped) found[base] = 1u;
  }
}
)"};

}  // namespace

WalkBench::WalkBench(std::shared_ptr<opengl::Context> context, const gpu_tracing::TriangleBvh& bvh)
    : context_(std::move(context)),
      bvh_(context_),
      triangle_count_(static_cast<std::uint32_t>(bvh.triangles.size())) {
  StageTimer timer;
  bvh_.load(bvh, timer);
}

std::vector<Walked> WalkBench::walk(const std::vector<ray_tracing::Ray>& rays) {
  return run(rays, true);
}

std::vector<Walked> WalkBench::try_all(const std::vector<ray_tracing::Ray>& rays) {
  return run(rays, false);
}

std::vector<Walked> WalkBench::run(const std::vector<ray_tracing::Ray>& rays, bool has_tree) {
  std::vector<opengl::ShaderFile> files(gpu_tracing::shader_files().begin(),
                                        gpu_tracing::shader_files().end());
  files.push_back(kAllHits);
  opengl::Defines defines;
  if (has_tree) defines.emplace_back("WITH_TREE", "1");
  opengl::Program& program = context_->program({files, {std::string(kAllHits.path)}, defines});
  std::vector<glm::vec4> packed;
  for (const ray_tracing::Ray& ray : rays) {
    packed.emplace_back(ray.origin, ray.t_max);
    packed.emplace_back(ray.direction, 0.0F);
  }
  const auto input = opengl::Buffer::of(context_, std::span<const glm::vec4>(packed));
  opengl::Buffer output(context_, std::max<std::size_t>(1, rays.size() * kWords) * 4);
  output.fill(0);
  bvh_.bind(program);
  program.storage(0, input);
  program.storage(1, output);
  program.set("ray_count", static_cast<std::uint32_t>(rays.size()));
  program.set("triangle_count", triangle_count_);
  program.dispatch(opengl::groups_for(static_cast<std::int64_t>(rays.size()), 64));
  const auto words = output.read<std::uint32_t>(rays.size() * kWords);
  std::vector<Walked> found(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t* own = words.data() + i * kWords;
    found[i].is_occluded = own[0] != 0;
    found[i].hits = own[1];
    found[i].triangles.assign(own + 2, own + 2 + std::min(own[1], kMostListed));
    std::ranges::sort(found[i].triangles);
  }
  return found;
}

}  // namespace renderers::test
