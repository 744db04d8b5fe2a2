#pragma once

#include <memory>

#include "renderers/many_lights/gather.h"
#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/texture.h"

namespace renderers::many_lights {

/// Radiance of the gathered light, summed over passes.
class Shade {
 public:
  explicit Shade(std::shared_ptr<opengl::Context> context);

  /// An empty sum.
  void begin(int width_px, int height_px);
  /// Adds weight x (albedo / pi x irradiance + glossy) where there is a surface.
  /// @param weight  1 / passes for the mean of so many
  void add(const opengl::GeometryBuffer& surfaces, const GatherTargets& light, bool with_glossy,
           float weight);

  /// rgba32f: radiance, W/(m2 sr); w: share of the weight that fell on surfaces.
  const opengl::Texture& radiance() const { return sum_; }

 private:
  std::shared_ptr<opengl::Context> context_;
  opengl::Texture sum_;
};

}  // namespace renderers::many_lights
