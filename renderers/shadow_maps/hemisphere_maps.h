#pragma once

#include <cstdint>
#include <memory>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/program.h"
#include "renderers/opengl/texture.h"

/// Shadow maps: distances to the nearest surface, seen from lights.
namespace renderers::shadow_maps {

/// Positions and axes of the maps' centres, read from a buffer of vec4: element i x stride is
/// (position, w: 0 to leave the map empty), the next one (axis, unit length; w: clip height, m).
///
/// What a texel's ray meets less than the clip height above the map's centre, measured along the
/// axis, is not seen (of splatted points: points lower than it); 0 clips nothing. The centre of a
/// cluster of lights on a curved surface lies inside that surface, which the height of the
/// cluster's members above its plane clips away. Real blockers that near are lost with it. A height
/// below 0 clips, up to its size, only surfaces whose back is seen (front: counterclockwise), so
/// that solids block light from without; of projected vertices and splatted points all.
struct MapOrigins {
  const opengl::Buffer* buffer = nullptr;
  int stride = 2;  ///< in vec4
};

/// How far a map's centre lies above its origin, along the axis, as a share of the diagonal of the
/// scene's bounds: the surface that holds the origin is then below the horizon whatever the
/// rounding of the origin's coordinates. What stands lower than this above the origin is not seen.
inline constexpr float kNearShare = 1e-4F;

/// Tolerances of lookups, in texels: a texel's extent is the angle it spans times the distance of
/// the receiver. The slope of the receiver needs none: the comparison is made on its plane
/// (shaders/hemisphere_map.glsl).
///
/// The defaults are for exact distances and were measured with pairs of surface points, 64 px: in
/// an empty closed box 0.7 % of the receivers are falsely dark, all along its edges; in cornell-box
/// 0.9 % of the irradiance is lost and 2.0 % leaks, about half of each at 128 px. A normal offset
/// made neither less.
struct LookupBias {
  float normal_offset = 0.0F;  ///< of the receiver along its normal, to the light's side
  float depth = 0.25F;         ///< of the compared distance
};

/// Layers of hemispherical maps around points: stereographic ("paraboloid", Brabec et al. 2002)
/// projection of the direction u in the frame of the axis, (x, y) = u.xy / (1 + u.z), the unit disc
/// scaled to the square (hemisphere_projection.h). Texels hold the bits of the distance to the
/// nearest surface, m, as a float (whose order is that of the bits), infinity where there is none.
class HemisphereMaps {
 public:
  /// Contents are undefined until `clear` or a fill.
  /// @throws UnsupportedError beyond the device's sizes or layers, naming size and limit
  HemisphereMaps(std::shared_ptr<opengl::Context> context, int size_px, int layers);

  /// r32ui, `layers` layers; lookups: shaders/hemisphere_map.glsl.
  const opengl::Texture& distances() const { return distances_; }
  int size_px() const { return distances_.shape().width_px; }
  int layers() const { return distances_.shape().layers; }
  /// Everything lit.
  void clear();

  /// Height of the centres above the origins, m; set by what fills the maps.
  float near_m() const { return near_m_; }
  void set_near_m(float near_m) { near_m_ = near_m; }

  const std::shared_ptr<opengl::Context>& context() const { return context_; }

 private:
  std::shared_ptr<opengl::Context> context_;
  opengl::Texture distances_;
  float near_m_ = 0.0F;
};

/// Sets everything that shaders/hemisphere_map.glsl declares in a program that includes it.
void bind_hemisphere_maps(opengl::Program& program, const HemisphereMaps& maps,
                          const LookupBias& bias);

}  // namespace renderers::shadow_maps
