#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/opengl/view.h"

/// Geometry between directions and the positions in an emitter's maps.
namespace renderers::many_lights {

/// Coordinates 2 and 3 of the Halton point of a sample, index + 1 + pass count.
glm::dvec2 halton_point(int index, int count, int pass);

/// A view along a direction, 90 degrees wide. @param forward  unit length
opengl::View view_along(const glm::vec3& origin, const glm::vec3& forward);

/// The six faces around a point, one of them along `axis` (unit length).
std::vector<opengl::View> cube_views(const glm::vec3& origin, const glm::vec3& axis);

/// Direction of a position in [0, 1]^2 of a perspective view's map, unit length.
glm::dvec3 direction_through(const opengl::View& view, const glm::dvec2& map_position);

/// Solid angle of a perspective view's map around a position, per unit of the map's area, sr:
/// 4 t^2 cos^3(theta), t the half-width's tangent, theta the angle to the axis [derived].
double map_solid_angle_sr(const opengl::View& view, const glm::dvec2& map_position);

/// Where views around one origin show a direction.
struct MapPlace {
  int view = 0;
  glm::dvec2 position{0.0};
};
MapPlace place_of(std::span<const opengl::View> views, const glm::dvec3& direction);

}  // namespace renderers::many_lights
