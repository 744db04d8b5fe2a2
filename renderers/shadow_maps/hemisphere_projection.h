#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// The projection of hemispherical maps in double precision; shaders/hemisphere.glsl is the same on
/// the device, see there for sources.
namespace renderers::shadow_maps {

/// Columns: tangent, bitangent, axis. @param axis  unit length
inline glm::dmat3 hemisphere_frame(const glm::dvec3& axis) {
  const double sign = std::copysign(1.0, axis.z);
  const double a = -1.0 / (sign + axis.z);
  const double b = axis.x * axis.y * a;
  return {{1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x},
          {b, sign + axis.y * axis.y * a, -axis.y},
          axis};
}

/// @param direction  in the frame, any length, not along minus the axis
/// @return within the unit disc for directions above the horizon
inline glm::dvec2 hemisphere_position(const glm::dvec3& direction) {
  return glm::dvec2(direction) / (glm::length(direction) + direction.z);
}

/// @return in the frame, unit length
inline glm::dvec3 hemisphere_direction(const glm::dvec2& position) {
  const double r2 = glm::dot(position, position);
  return glm::dvec3(2.0 * position, 1.0 - r2) / (1.0 + r2);
}

/// Solid angle per area of the map at a position, sr; the whole disc gives 2 pi.
inline double hemisphere_solid_angle_density(const glm::dvec2& position) {
  const double r2 = glm::dot(position, position);
  return 4.0 / ((1.0 + r2) * (1.0 + r2));
}

/// Centre of a texel, which may lie beyond the rim.
inline glm::dvec2 hemisphere_texel_center(const glm::ivec2& texel, int size_px) {
  return (2.0 * glm::dvec2(texel) + 1.0) / static_cast<double>(size_px) - 1.0;
}

/// Position at which a texel is sampled: its centre, or the nearest point of the rim.
inline glm::dvec2 hemisphere_texel_position(const glm::ivec2& texel, int size_px) {
  const glm::dvec2 center = hemisphere_texel_center(texel, size_px);
  return center / std::fmax(1.0, glm::length(center));
}

/// Solid angle of a texel, sr, 0 for one whose centre lies beyond the rim; a texel covers
/// (2 / size)^2 of the map.
inline double hemisphere_texel_solid_angle(const glm::ivec2& texel, int size_px) {
  const glm::dvec2 center = hemisphere_texel_center(texel, size_px);
  if (glm::dot(center, center) > 1.0) return 0.0;
  const double width = 2.0 / size_px;
  return hemisphere_solid_angle_density(center) * width * width;
}

/// True if a part of the texel lies within the disc: these are the ones that maps fill.
inline bool hemisphere_texel_is_used(const glm::ivec2& texel, int size_px) {
  const double reach = 1.0 + std::numbers::sqrt2 / size_px;
  const glm::dvec2 center = hemisphere_texel_center(texel, size_px);
  return glm::dot(center, center) <= reach * reach;
}

/// Angle that a texel spans in a direction, rad. @param cosine  of the direction to the axis
inline double hemisphere_texel_angle(double cosine, int size_px) {
  return 2.0 * (1.0 + cosine) / size_px;
}

/// The texel that holds a position.
inline glm::ivec2 hemisphere_texel(const glm::dvec2& position, int size_px) {
  const auto index = [size_px](double coordinate) {
    const int texel = static_cast<int>(std::floor((0.5 * coordinate + 0.5) * size_px));
    return std::min(std::max(texel, 0), size_px - 1);
  };
  return {index(position.x), index(position.y)};
}

}  // namespace renderers::shadow_maps
