#pragma once

#include <array>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace renderers::element_hierarchy {

/// Solid angle of a triangle from a point, sr; its two sides count alike.
/// Source: van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle",
/// doi:10.1109/TBME.1983.325207, Eq. 8 (number recalled).
double solid_angle(const glm::vec3& point, const std::array<glm::vec3, 3>& triangle);

/// A point of a triangle, uniform in the solid angle from another point.
struct TrianglePoint {
  glm::vec2 weights{0.0F};   ///< of the second and third corner
  double solid_angle = 0.0;  ///< of the whole triangle, sr: 1 / density
};

/// Uniform by solid angle; by area where the triangle is too small for the difference to matter
/// (below 1e-3 sr): then `solid_angle` is that of the area seen from this point.
/// @param u  in [0, 1)^2
/// Source: Arvo 1995, "Stratified Sampling of Spherical Triangles", doi:10.1145/218380.218500.
TrianglePoint sample_solid_angle(const glm::vec3& from, const std::array<glm::vec3, 3>& triangle,
                                 const glm::vec2& u);

}  // namespace renderers::element_hierarchy
