#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// Directions drawn from the unit square.
namespace renderers::ray_tracing {

inline constexpr float kPi = std::numbers::pi_v<float>;

/// Right-handed orthonormal frame around a unit vector.
struct Frame3 {
  glm::vec3 tangent;
  glm::vec3 bitangent;
  glm::vec3 normal;

  glm::vec3 to_world(const glm::vec3& local) const {
    return local.x * tangent + local.y * bitangent + local.z * normal;
  }
};

/// Source: Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), Listing 3.
inline Frame3 frame_around(const glm::vec3& normal) {
  const float sign = std::copysign(1.0F, normal.z);
  const float a = -1.0F / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  return {{1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
          {b, sign + normal.y * normal.y * a, -normal.y},
          normal};
}

/// Cosine-distributed direction around +z, pdf cos / pi.
/// @param u  in [0, 1)^2
/// Source: Malley's method; Shirley and Kenyon, Realistic Ray Tracing; disk in polar coordinates.
inline glm::vec3 cosine_hemisphere(const glm::vec2& u) {
  const float radius = std::sqrt(u.x);
  const float azimuth_rad = 2.0F * kPi * u.y;
  return {radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), std::sqrt(1.0F - u.x)};
}

/// Direction around +z with density (n + 1) / (2 pi) cos^n.
/// @param u  in [0, 1)^2  @param exponent  n >= 0
/// Source: Lafortune and Willems 1994, Sec. 3.
inline glm::vec3 cosine_power_lobe(const glm::vec2& u, float exponent) {
  // 1 - u.x lies in (0, 1], where the power is defined for every exponent.
  const float cosine = std::pow(1.0F - u.x, 1.0F / (exponent + 1.0F));
  const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
  const float azimuth_rad = 2.0F * kPi * u.y;
  return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine};
}

/// Uniform barycentrics (weights of the second and third vertex) on a triangle.
/// Source: Turk 1990, "Generating Random Points in Triangles", Graphics Gems.
inline glm::vec2 uniform_triangle(const glm::vec2& u) {
  const float root = std::sqrt(u.x);
  return {root * (1.0F - u.y), root * u.y};
}

}  // namespace renderers::ray_tracing
