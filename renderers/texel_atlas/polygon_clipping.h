#pragma once

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

namespace renderers::texel_atlas {

/// A convex polygon of at most `kMostCorners` corners in the plane.
struct Polygon {
  /// A triangle has three; each of four half planes adds at most one.
  static constexpr std::size_t kMostCorners = 7;
  std::array<glm::dvec2, kMostCorners> corners{};
  std::size_t count = 0;
};

/// Area and centroid of a piece of a triangle.
struct Piece {
  double area = 0.0;  ///< square of the coordinates' unit, >= 0
  glm::dvec2 centroid{0.0};
};

/// The part of a triangle inside the axis-aligned rectangle.
/// Source: Sutherland and Hodgman 1974, "Reentrant Polygon Clipping", doi:10.1145/360767.360802.
Polygon clip_to_rectangle(const std::array<glm::dvec2, 3>& triangle, const glm::dvec2& least,
                          const glm::dvec2& greatest);

/// Exact area and centroid by the fan of triangles from the first corner.
Piece measure(const Polygon& polygon);

}  // namespace renderers::texel_atlas
