#include "renderers/element_hierarchy/form_factor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

namespace renderers::element_hierarchy {

namespace {

/// A triangle cut by a plane has at most four corners.
struct Polygon {
  std::array<glm::dvec3, 4> corners;
  std::size_t count = 0;
  void add(const glm::dvec3& corner) { corners[count++] = corner; }
};

/// The part of a triangle with height >= 0. @param triangle  relative to the point
Polygon above_horizon(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal) {
  Polygon part;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3& from = triangle[i];
    const glm::dvec3& to = triangle[(i + 1) % 3];
    const double height_from = glm::dot(from, normal);
    const double height_to = glm::dot(to, normal);
    if (height_from >= 0.0) part.add(from);
    if ((height_from > 0.0 && height_to < 0.0) || (height_from < 0.0 && height_to > 0.0)) {
      part.add(from + (height_from / (height_from - height_to)) * (to - from));
    }
  }
  return part;
}

/// Sum of theta_i g_i over the edges.
glm::dvec3 edge_sum(const glm::dvec3* corners, std::size_t count) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3& from = corners[i];
    const glm::dvec3& to = corners[(i + 1) % count];
    const glm::dvec3 cross = glm::cross(from, to);
    const double length = glm::length(cross);
    if (length <= 0.0) continue;  // the edge points at the point
    sum += (std::atan2(length, glm::dot(from, to)) / length) * cross;
  }
  return sum;
}

std::array<glm::dvec3, 3> relative_to(const glm::vec3& point,
                                      const std::array<glm::vec3, 3>& triangle) {
  const glm::dvec3 origin(point);
  return {glm::dvec3(triangle[0]) - origin, glm::dvec3(triangle[1]) - origin,
          glm::dvec3(triangle[2]) - origin};
}

}  // namespace

double point_form_factor(const glm::vec3& point, const glm::vec3& normal,
                         const std::array<glm::vec3, 3>& triangle) {
  const Polygon part = above_horizon(relative_to(point, triangle), glm::dvec3(normal));
  if (part.count < 3) return 0.0;
  const double sum = glm::dot(glm::dvec3(normal), edge_sum(part.corners.data(), part.count));
  return std::min(1.0, std::fabs(sum) / (2.0 * std::numbers::pi));
}

glm::dvec3 vector_form_factor(const glm::vec3& point, const std::array<glm::vec3, 3>& triangle) {
  const auto corners = relative_to(point, triangle);
  const glm::dvec3 sum = edge_sum(corners.data(), 3) / (2.0 * std::numbers::pi);
  // Towards the triangle, whichever way its corners turn.
  return glm::dot(sum, corners[0] + corners[1] + corners[2]) < 0.0 ? -sum : sum;
}

bool face_away(const Element& a, const Element& b) {
  const auto is_in_front = [](const Element& of, const Element& other) {
    return std::ranges::any_of(other.positions, [&](const glm::vec3& corner) {
      return glm::dot(corner - of.positions[0], of.normal) > 1e-6F * of.extent_m();
    });
  };
  return !is_in_front(a, b) || !is_in_front(b, a);
}

}  // namespace renderers::element_hierarchy
