#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <glm/vec3.hpp>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/framebuffer.h"
#include "renderers/opengl/program.h"
#include "renderers/opengl/texture.h"

namespace renderers::clustered_visibility {

/// What is clustered: buffers of LightClusters, which begin as its start has left them.
struct ScatterInput {
  const opengl::Buffer& lights;
  const opengl::Buffer& assignments;
  const opengl::Buffer& centers;
  const opengl::Buffer& summary;
  int light_count;
  int iterations;        ///< at most
  glm::vec3 bounds_min;  ///< of the scene, m: positions are summed above it
  /// Sets the rule of distances (uniforms of cluster_rule.glsl).
  std::function<void(opengl::Program&)> set_rule;
};

/// Iterations of k-means whose sums the rasteriser makes, as Dong et al. 2009, Sec. 6: every light
/// is a point in the pixel of its cluster, blended additively. Sums are floats in the order that
/// the device draws in: on devices that draw in any order, runs differ in their last bits, which
/// then may decide ties.
class ScatterClusters {
 public:
  /// @throws UnsupportedError if the device cannot blend rgba32f
  ScatterClusters(std::shared_ptr<opengl::Context> context, int clusters);

  void run(const ScatterInput& input);
  std::int64_t memory_bytes() const;

 private:
  std::shared_ptr<opengl::Context> context_;
  opengl::Texture sums_;  ///< clusters x 2
  opengl::Framebuffer target_;
  opengl::Buffer state_;
};

}  // namespace renderers::clustered_visibility
