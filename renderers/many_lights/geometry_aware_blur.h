#pragma once

#include <cstdint>
#include <memory>

#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/texture.h"

namespace renderers::many_lights {

enum class BlurKind {
  box,        ///< the n x n window, for even n half a pixel off centre, as the paper
  separable,  ///< rows, then columns of that window; not the same, as acceptance is not separable
  centred     ///< for even n rows and columns of n + 1 taps, those at the ends with half the weight
};

struct BlurSettings {
  BlurKind kind = BlurKind::separable;
  int interleave = 8;    ///< n; 1: the picture is taken over as it is
  float alpha_m = 0.0F;  ///< neighbours are nearer than this; the paper: 10 % of the scene's extent
  float beta = 0.8F;     ///< and their shading normal's cosine to the pixel's is above this
};

/// Mean over the window of an interleaved gather, within one surface: every window of n x n pixels
/// holds each class once, so on a flat surface the mean is the sum over all lights.
/// Source: Segovia et al. 2006, "Non-interleaved Deferred Shading of Interleaved Sample Patterns",
/// doi:10.2312/EGGH/EGGH06/053-060, Sec. 4; weights 0 and 1, divided by the accepted weight.
class GeometryAwareBlur {
 public:
  explicit GeometryAwareBlur(std::shared_ptr<opengl::Context> context);

  /// @param values  rgba32f, as large as the surfaces; replaced by the means
  void apply(const opengl::GeometryBuffer& surfaces, const BlurSettings& settings,
             opengl::Texture& values);

  std::int64_t memory_bytes() const;

 private:
  struct Window;
  void run(const opengl::GeometryBuffer& surfaces, const BlurSettings& settings,
           const Window& window, const opengl::Texture& from, const opengl::Texture& to);

  std::shared_ptr<opengl::Context> context_;
  opengl::Texture rows_;
};

}  // namespace renderers::many_lights
