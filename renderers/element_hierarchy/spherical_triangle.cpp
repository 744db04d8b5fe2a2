#include "renderers/element_hierarchy/spherical_triangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"

namespace renderers::element_hierarchy {

namespace {

using Corners = std::array<glm::dvec3, 3>;

/// Below, the density by area is that by solid angle up to a few per cent.
constexpr double kSmall_sr = 1e-3;

Corners unit_corners(const glm::vec3& point, const std::array<glm::vec3, 3>& triangle) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 offset = glm::dvec3(triangle[i]) - glm::dvec3(point);
    const double length = glm::length(offset);
    corners[i] = length > 0.0 ? offset / length : glm::dvec3(0.0);
  }
  return corners;
}

double solid_angle_of(const Corners& c) {
  const double volume = std::fabs(glm::dot(c[0], glm::cross(c[1], c[2])));
  const double sum = 1.0 + glm::dot(c[0], c[1]) + glm::dot(c[1], c[2]) + glm::dot(c[2], c[0]);
  return 2.0 * std::atan2(volume, sum);
}

/// Part of a vector perpendicular to a unit vector, unit length.
glm::dvec3 perpendicular(const glm::dvec3& vector, const glm::dvec3& axis) {
  const glm::dvec3 rest = vector - glm::dot(vector, axis) * axis;
  const double length = glm::length(rest);
  return length > 0.0 ? rest / length : glm::dvec3(0.0);
}

/// Angle of the spherical triangle at corner `at`.
double corner_angle(const Corners& c, std::size_t at) {
  const glm::dvec3 one = perpendicular(c[(at + 1) % 3], c[at]);
  const glm::dvec3 other = perpendicular(c[(at + 2) % 3], c[at]);
  return std::acos(std::clamp(glm::dot(one, other), -1.0, 1.0));
}

/// Arvo 1995, Fig. 2: the triangle up to C' has the share u.x of the area, P lies between B and C'.
glm::dvec3 arvo_direction(const Corners& c, double area_sr, const glm::vec2& u) {
  const double alpha = corner_angle(c, 0);
  const double phi = static_cast<double>(u.x) * area_sr - alpha;
  const double s = std::sin(phi);
  const double t = std::cos(phi);
  const double p = t - std::cos(alpha);
  const double v = s + std::sin(alpha) * glm::dot(c[0], c[1]);
  const double denominator = (v * s + p * t) * std::sin(alpha);
  double q = denominator != 0.0 ? ((v * t - p * s) * std::cos(alpha) - v) / denominator : 1.0;
  q = std::clamp(q, -1.0, 1.0);
  const glm::dvec3 new_corner = q * c[0] + std::sqrt(1.0 - q * q) * perpendicular(c[2], c[0]);
  const double z = 1.0 - static_cast<double>(u.y) * (1.0 - glm::dot(new_corner, c[1]));
  return z * c[1] + std::sqrt(std::max(0.0, 1.0 - z * z)) * perpendicular(new_corner, c[1]);
}

}  // namespace

double solid_angle(const glm::vec3& point, const std::array<glm::vec3, 3>& triangle) {
  return solid_angle_of(unit_corners(point, triangle));
}

TrianglePoint sample_solid_angle(const glm::vec3& from, const std::array<glm::vec3, 3>& triangle,
                                 const glm::vec2& u) {
  const Corners corners = unit_corners(from, triangle);
  const double area_sr = solid_angle_of(corners);
  const glm::dvec3 a(triangle[0]);
  const glm::dvec3 edge_b = glm::dvec3(triangle[1]) - a;
  const glm::dvec3 edge_c = glm::dvec3(triangle[2]) - a;
  const glm::dvec3 normal = glm::cross(edge_b, edge_c);
  TrianglePoint point;
  const glm::dvec3 to_a = a - glm::dvec3(from);
  if (area_sr < kSmall_sr) {
    point.weights = ray_tracing::uniform_triangle(u);
    const glm::dvec3 to = to_a + static_cast<double>(point.weights.x) * edge_b +
                          static_cast<double>(point.weights.y) * edge_c;
    // dA cos / r^2, cos from the scaled normal: half of it is the area.
    const double distance2 = std::max(glm::dot(to, to), 1e-60);
    point.solid_angle = 0.5 * std::fabs(glm::dot(normal, to)) / (distance2 * std::sqrt(distance2));
    return point;
  }
  point.solid_angle = area_sr;
  const glm::dvec3 direction = arvo_direction(corners, area_sr, u);
  const double distance = glm::dot(normal, to_a) / glm::dot(normal, direction);
  const glm::dvec3 place = distance * direction - to_a;
  const double scale = 1.0 / glm::dot(normal, normal);
  double weight_b = glm::dot(glm::cross(place, edge_c), normal) * scale;
  double weight_c = glm::dot(glm::cross(edge_b, place), normal) * scale;
  // Rounding must not leave the triangle.
  weight_b = std::clamp(std::isfinite(weight_b) ? weight_b : 1.0 / 3.0, 0.0, 1.0);
  weight_c = std::clamp(std::isfinite(weight_c) ? weight_c : 1.0 / 3.0, 0.0, 1.0 - weight_b);
  point.weights = {static_cast<float>(weight_b), static_cast<float>(weight_c)};
  return point;
}

}  // namespace renderers::element_hierarchy
