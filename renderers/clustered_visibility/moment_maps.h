#pragma once

#include <cstdint>
#include <memory>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/program.h"
#include "renderers/opengl/texture.h"
#include "renderers/shadow_maps/hemisphere_maps.h"

namespace renderers::clustered_visibility {

/// Layers of hemispherical shadow maps as the first four powers of their depth, filtered in levels.
/// Source: Peters and Klein 2015, "Moment Shadow Mapping", I3D, doi:10.1145/2699276.2699277,
/// recalled; what is read from them: shaders/moment_filter.glsl. Depths in [0, 1] are taken to
/// [-1, 1] and stored in 32 bits, so that no bits are lost to quantization (the paper's 16 bits
/// need its optimized basis).
class MomentMaps {
 public:
  /// @param size_px  a power of two, at least 4
  /// @throws UnsupportedError beyond the device's sizes or layers
  MomentMaps(std::shared_ptr<opengl::Context> context, int size_px, int layers);

  /// Makes all levels from filled maps.
  /// @param area_lights  a layer's AreaLight (light_clusters.h); layers without lights are left out
  void make(const shadow_maps::HemisphereMaps& distances, const opengl::Buffer& area_lights);

  /// Sets the sampler that shaders/moment_filter.glsl declares.
  void bind(opengl::Program& program) const { program.sampler(4, moments_); }

  /// rgba: means of z, z^2, z^3, z^4; z = 2 depth - 1.
  const opengl::Texture& moments() const { return moments_; }
  /// Of the layers alone, without what is needed to make them.
  std::int64_t layer_bytes() const { return opengl::size_bytes_of(moments_.shape()); }
  std::int64_t memory_bytes() const {
    return layer_bytes() + static_cast<std::int64_t>(sums_.size_bytes());
  }

 private:
  std::shared_ptr<opengl::Context> context_;
  opengl::Texture moments_;
  opengl::Buffer sums_;
};

}  // namespace renderers::clustered_visibility
