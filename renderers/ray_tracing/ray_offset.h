#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

/// Bounds of the rounding error of points on triangles, and ray origins that keep clear of it.
///
/// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed. 2016, Sec. 3.9 "Managing
/// Rounding Error": running error analysis instead of a fixed epsilon, so that a scene may be of
/// any scale. The idea to move the origin along the geometric normal by units in the last place is
/// also that of Waechter and Binder, "A Fast and Robust Method for Avoiding Self-Intersection",
/// Ray Tracing Gems 2019, ch. 6.
namespace renderers::ray_tracing {

/// Bound of the relative error of n chained float operations (Higham 2002, Sec. 3.1):
/// n u / (1 - n u), u = half the machine epsilon.
constexpr float rounding_bound(int operations) {
  constexpr float kUnitRoundoff = std::numeric_limits<float>::epsilon() * 0.5F;
  const float product = static_cast<float>(operations) * kUnitRoundoff;
  return product / (1.0F - product);
}

/// Roundings between the vertices of a triangle and the plane distance of a point on it: seven to
/// interpolate the point, nine in the intersector (subtract the origin, cross product, dot
/// product).
inline constexpr int kTrianglePointOperations = 16;

/// Bound of the absolute error of a point on a triangle, per coordinate; never 0, because the
/// intersector adds the terms of all axes and a ray from exactly on a plane meets it.
/// @param a, b, c  the vertices
inline glm::vec3 triangle_point_error(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 extent = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
  const float largest = std::max(extent.x, std::max(extent.y, extent.z));
  return rounding_bound(kTrianglePointOperations) * extent + glm::vec3(rounding_bound(1) * largest);
}

/// Barycentrics kept away from the edges by twice the point's error: a point beyond an edge could
/// lie behind the neighbouring triangle, and rays from it would leak out of a closed corner. Holds
/// for corners of 45 degrees and more, where the offset along the normal is no larger.
///
/// @param weight         of the vertices a, b, c, sum 1
/// @param scaled_normal  cross(b - a, c - a)
/// @param error          bound of the point's error, per coordinate
inline glm::vec3 weights_off_edges(const glm::vec3& weight, const glm::vec3& a, const glm::vec3& b,
                                   const glm::vec3& c, const glm::vec3& scaled_normal,
                                   const glm::vec3& error) {
  constexpr float kMargin = 2.0F;
  const float longest2 =
      std::max(glm::dot(b - a, b - a), std::max(glm::dot(c - a, c - a), glm::dot(c - b, c - b)));
  // A weight is the distance from an edge by the triangle's height over it, 2 A / edge.
  const float least2 = kMargin * kMargin * glm::dot(error, error) * longest2 /
                       glm::dot(scaled_normal, scaled_normal);
  const float smallest = std::min(weight.x, std::min(weight.y, weight.z));
  if (smallest >= 0.0F && smallest * smallest >= least2) return weight;
  // Towards the centroid, where all weights are a third; a sliver has no room for more.
  const float least = std::min(std::sqrt(least2), 1.0F / 3.0F);
  const glm::vec3 raised = glm::max(weight, glm::vec3(least));
  return raised / (raised.x + raised.y + raised.z);
}

/// The next float above a finite number, or below it: std::nextafter without its special cases,
/// inlined.
inline float next_float(float value, bool is_upward) {
  if (value == 0.0F) {
    constexpr float kLeast = std::numeric_limits<float>::denorm_min();
    return is_upward ? kLeast : -kLeast;
  }
  const auto bits = std::bit_cast<std::uint32_t>(value);
  // Away from zero the bits of the magnitude count up.
  return std::bit_cast<float>((value > 0.0F) == is_upward ? bits + 1 : bits - 1);
}

/// The point moved along the surface normal, beyond the error box, to the side of a direction.
///
/// @param position   on the surface
/// @param error      bound of its error, per coordinate
/// @param normal     geometric, unit length, either side
/// @param direction  any length; which side of the surface the ray leaves to
inline glm::vec3 offset_from_surface(const glm::vec3& position, const glm::vec3& error,
                                     const glm::vec3& normal, const glm::vec3& direction) {
  const float distance = glm::dot(glm::abs(normal), error);
  const glm::vec3 offset =
      glm::dot(direction, normal) < 0.0F ? -distance * normal : distance * normal;
  glm::vec3 moved = position + offset;
  // The sum was rounded; one more unit in the last place keeps it on the far side.
  for (int axis = 0; axis < 3; ++axis) {
    if (offset[axis] == 0.0F) continue;
    moved[axis] = next_float(moved[axis], offset[axis] > 0.0F);
  }
  return moved;
}

/// Share of a segment that a shadow ray covers: short of its end by the rounding of the end's
/// distance, which grows with the segment's length.
inline constexpr float kSegmentEnd = 1.0F - rounding_bound(kTrianglePointOperations);

}  // namespace renderers::ray_tracing
