#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "renderers/indirect_view/hemisphere_rays.h"

namespace renderers::irradiance_cache {

/// Cells of equal weight cos / pi of a hemisphere: M by polar angle, N by azimuth.
struct GridSize {
  int polar = 8;     ///< M, >= 2
  int azimuth = 24;  ///< N, >= 3
};
/// About as many cells as rays, N about pi M. @param rays  >= 6
GridSize grid_size(int rays);

/// Irradiance and how it changes, each gradient per channel.
struct IrradianceRecord {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};      ///< unit length
  glm::vec3 irradiance{0.0F};  ///< W/m2
  /// W/m2 per radian: a turn by the vector t (axis times angle) adds dot(t, rotation).
  std::array<glm::vec3, 3> rotation{};
  std::array<glm::vec3, 3> translation{};  ///< W/m3
  float radius_m = 0.0F;                   ///< harmonic mean of the distances, then bounded
};

/// Bounds of what distances do.
struct SpacingBounds {
  float least_m = 0.0F;
  float greatest_m = 0.0F;
  /// Nor further than the irradiance takes to change by all of itself: E over its gradient.
  bool by_gradient = true;
};

/// A record by one ray through each cell of a hemisphere's grid.
///
/// Sources: Ward, Rubinstein, Clear 1988, "A Ray Tracing Solution for Diffuse Interreflection",
/// doi:10.1145/54852.378490 (harmonic mean distance); Ward and Heckbert 1992, "Irradiance
/// Gradients", EGWR, Eqs. 2 and 3 of the gradients (numbers recalled). Differs from the paper: the
/// sign of the rotational gradient is the one derived for a turn by N_i x N, which the tests hold
/// against a closed form; distances below the least spacing count as that.
/// @param point     the record's place; its normal is the hemisphere's
/// @param radiance  of what a ray meets  @param cast  counts the rays
IrradianceRecord sample_record(const ray_tracing::RayScene& rays,
                               const indirect_view::ViewedPoint& point, const GridSize& size,
                               const SpacingBounds& bounds,
                               const indirect_view::RayRadiance& radiance, std::uint64_t& cast);

}  // namespace renderers::irradiance_cache
