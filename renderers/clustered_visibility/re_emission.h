#pragma once

#include <cstdint>
#include <memory>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/opengl/texture.h"
#include "renderers/shadow_maps/scene_points.h"

namespace renderers::clustered_visibility {

/// Surfaces that receive light and send it on as virtual lights, on the device: one bounce more
/// (Dong et al. 2009, Sec. 8 name it future work; the way is ours).
///
/// N points stand for the scene's surfaces, for the area A / N each (A: of one side). Both sides of
/// a surface reflect, so each point is two receivers, whose irradiance E any gather may find. The
/// light that a point becomes has the flux of one side,
///   Phi = albedo E A / N,
/// which is radiance albedo E / pi of a piece of the area A / N. Where both sides of a point are
/// lit one of them is drawn, with the probability p = its share of the luminance, and has the flux
/// Phi / p: right in expectation, and its luminance is the sum of both sides'. Draws are a part of
/// the points, not random; where only one side is lit it is that one as it is.
class ReEmission {
 public:
  /// @param lights  N >= 1
  ReEmission(std::shared_ptr<opengl::Context> context, int lights);

  /// Places the receivers. @param points  N of the scene, or none: nothing receives
  void place(const shadow_maps::SurfacePoints& points, const opengl::GpuScene& scene);
  /// Point i of the list has texels i (front) and N + i (back), row-major; those left over show no
  /// surface.
  const opengl::GeometryBuffer& receivers() const { return receivers_; }

  /// Makes the lights. @param irradiance  rgba32f: of the receivers, W/m2
  void emit(const opengl::Texture& irradiance);
  /// N VirtualLight; a point's is the one at its `place`.
  const opengl::Buffer& lights() const { return lights_; }
  int light_count() const { return light_count_; }
  std::int64_t memory_bytes() const;

 private:
  std::shared_ptr<opengl::Context> context_;
  int light_count_;
  int point_count_ = 0;  ///< N or 0
  float point_area_m2_ = 0.0F;
  opengl::GeometryBuffer receivers_;
  opengl::Buffer points_;  ///< `PlacedPoint` of shaders/placed_point.glsl
  opengl::Buffer lights_;
};

}  // namespace renderers::clustered_visibility
