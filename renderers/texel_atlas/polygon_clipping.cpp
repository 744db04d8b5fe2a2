#include "renderers/texel_atlas/polygon_clipping.h"

#include <cmath>

namespace renderers::texel_atlas {

namespace {

/// Keeps the side of a line along an axis: sign (p[axis] - at) >= 0.
Polygon clip_to_side(const Polygon& polygon, int axis, double at, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec2& a = polygon.corners[i];
    const glm::dvec2& b = polygon.corners[(i + 1) % polygon.count];
    const double side_a = sign * (a[axis] - at);
    const double side_b = sign * (b[axis] - at);
    if (side_a >= 0.0) kept.corners[kept.count++] = a;
    if ((side_a > 0.0 && side_b < 0.0) || (side_a < 0.0 && side_b > 0.0)) {
      glm::dvec2 crossing = a + side_a / (side_a - side_b) * (b - a);
      crossing[axis] = at;
      kept.corners[kept.count++] = crossing;
    }
  }
  return kept;
}

}  // namespace

Polygon clip_to_rectangle(const std::array<glm::dvec2, 3>& triangle, const glm::dvec2& least,
                          const glm::dvec2& greatest) {
  Polygon polygon;
  for (const glm::dvec2& corner : triangle) polygon.corners[polygon.count++] = corner;
  for (int axis = 0; axis < 2; ++axis) {
    polygon = clip_to_side(polygon, axis, least[axis], 1.0);
    polygon = clip_to_side(polygon, axis, greatest[axis], -1.0);
  }
  return polygon;
}

Piece measure(const Polygon& polygon) {
  Piece piece;
  if (polygon.count < 3) return piece;
  const glm::dvec2& a = polygon.corners[0];
  double twice_area = 0.0;
  glm::dvec2 moment(0.0);
  for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
    const glm::dvec2 b = polygon.corners[i] - a;
    const glm::dvec2 c = polygon.corners[i + 1] - a;
    const double cross = b.x * c.y - b.y * c.x;
    twice_area += cross;
    moment += cross * (b + c);
  }
  piece.area = 0.5 * std::fabs(twice_area);
  piece.centroid = twice_area == 0.0 ? a : a + moment / (3.0 * twice_area);
  return piece;
}

}  // namespace renderers::texel_atlas
