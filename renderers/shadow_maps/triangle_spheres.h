#pragma once

#include <cstdint>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/gpu_scene.h"

namespace renderers::shadow_maps {

/// Spheres around a scene's triangles, for culling (shaders/triangle_spheres.comp.glsl).
class TriangleSpheres {
 public:
  /// Makes them anew. @param scene  with at least one triangle
  void load(const opengl::GpuScene& scene);
  /// vec4 each: centre in world space, m; w: radius, m, which covers the rounding.
  const opengl::Buffer& spheres() const { return spheres_; }
  std::int64_t memory_bytes() const { return static_cast<std::int64_t>(spheres_.size_bytes()); }

 private:
  opengl::Buffer spheres_;
};

}  // namespace renderers::shadow_maps
