#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderers/gpu_tracing/gpu_bvh.h"
#include "renderers/opengl/context.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::test {

/// What one ray found.
struct Walked {
  bool is_occluded = false;
  /// All on the ray, sorted; of many only the first 64 found.
  std::vector<std::uint32_t> triangles;
  std::uint32_t hits = 0;  ///< how many these are
};

/// Shaders of a user of shaders/bvh.glsl: any triangle on a ray, all of them, and both without the
/// hierarchy, triangle by triangle.
class WalkBench {
 public:
  WalkBench(std::shared_ptr<opengl::Context> context, const gpu_tracing::TriangleBvh& bvh);

  std::vector<Walked> walk(const std::vector<ray_tracing::Ray>& rays);
  std::vector<Walked> try_all(const std::vector<ray_tracing::Ray>& rays);

 private:
  std::vector<Walked> run(const std::vector<ray_tracing::Ray>& rays, bool has_tree);

  std::shared_ptr<opengl::Context> context_;
  gpu_tracing::GpuBvh bvh_;
  std::uint32_t triangle_count_;
};

}  // namespace renderers::test
