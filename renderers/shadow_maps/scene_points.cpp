#include "renderers/shadow_maps/scene_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "renderers/ray_tracing/direction_sampling.h"

namespace renderers::shadow_maps {

namespace {

struct WorldTriangle {
  glm::vec3 vertex[3];
  glm::vec3 normal;    ///< unit length
  int index;           ///< among the scene's
  double area_end_m2;  ///< sum of the areas up to this triangle
};

std::vector<WorldTriangle> triangles_with_area(const scene::Scene& scene) {
  std::vector<WorldTriangle> triangles;
  double area_m2 = 0.0;
  int next = 0;
  for (const scene::Object& object : scene.objects) {
    for (const glm::uvec3& index : object.mesh->triangles) {
      WorldTriangle triangle{};
      triangle.index = next++;
      for (int i = 0; i < 3; ++i) {
        triangle.vertex[i] =
            glm::vec3(object.to_world * glm::vec4(object.mesh->positions[index[i]], 1.0F));
      }
      const glm::vec3 scaled = glm::cross(triangle.vertex[1] - triangle.vertex[0],
                                          triangle.vertex[2] - triangle.vertex[0]);
      const float length = glm::length(scaled);
      if (!(length > 0.0F)) continue;
      triangle.normal = scaled / length;
      area_m2 += 0.5 * static_cast<double>(length);
      triangle.area_end_m2 = area_m2;
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

/// Digits of the index in base 2, mirrored at the point.
std::uint32_t radical_inverse_bits(std::uint32_t index) {
  std::uint32_t inverse = 0;
  for (int bit = 0; bit < 32; ++bit) inverse |= ((index >> bit) & 1U) << (31 - bit);
  return inverse;
}

/// Indices in the order of their radical inverses.
std::vector<std::size_t> radical_order(int count) {
  std::vector<std::size_t> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [](std::size_t index) {
    return radical_inverse_bits(static_cast<std::uint32_t>(index));
  });
  return order;
}

/// Roberts 2018: multiples of the inverse powers of the plastic number, modulo 1.
glm::dvec2 r2_sequence(std::size_t index) {
  constexpr double kPlastic = 1.32471795724474602596;
  const auto n = static_cast<double>(index);
  const glm::dvec2 point(0.5 + n / kPlastic, 0.5 + n / (kPlastic * kPlastic));
  return {point.x - std::floor(point.x), point.y - std::floor(point.y)};
}

glm::vec3 point_within(const WorldTriangle& triangle, const glm::dvec2& u) {
  const glm::vec2 weight = ray_tracing::uniform_triangle(glm::vec2(u));
  return triangle.vertex[0] + weight.x * (triangle.vertex[1] - triangle.vertex[0]) +
         weight.y * (triangle.vertex[2] - triangle.vertex[0]);
}

}  // namespace

std::vector<ScenePoint> scene_points(const scene::Scene& scene, int sets, int points_per_set) {
  const std::vector<WorldTriangle> triangles = triangles_with_area(scene);
  if (triangles.empty()) return {};
  const double area_m2 = triangles.back().area_end_m2;
  const auto radius_m =
      static_cast<float>(std::sqrt(area_m2 / (std::numbers::pi * points_per_set)));

  const std::vector<std::size_t> order = radical_order(sets);
  const auto per_set = static_cast<std::size_t>(points_per_set);
  std::vector<ScenePoint> points(order.size() * per_set);
  std::size_t triangle = 0;
  for (std::size_t piece = 0; piece < points.size(); ++piece) {
    const double at_m2 =
        (static_cast<double>(piece) + 0.5) / static_cast<double>(points.size()) * area_m2;
    while (triangle + 1 < triangles.size() && triangles[triangle].area_end_m2 <= at_m2) ++triangle;
    const std::size_t index = order[piece % order.size()] * per_set + piece / order.size();
    points[index] = {glm::vec4(point_within(triangles[triangle], r2_sequence(index)), radius_m),
                     glm::vec4(triangles[triangle].normal, 0.0F)};
  }
  return points;
}

SurfacePoints surface_points(const scene::Scene& scene, int set, int count) {
  const std::vector<WorldTriangle> triangles = triangles_with_area(scene);
  if (triangles.empty()) return {};
  SurfacePoints result{triangles.back().area_end_m2, {}};
  const std::vector<std::size_t> places = radical_order(count);
  // Half a piece for set 0, as far from it as can be for set 1, and so on.
  const double share =
      static_cast<double>(radical_inverse_bits(static_cast<std::uint32_t>(set) + 1)) * 0x1p-32;
  std::size_t triangle = 0;
  for (std::size_t piece = 0; piece < places.size(); ++piece) {
    const double at_m2 =
        (static_cast<double>(piece) + share) / static_cast<double>(count) * result.area_m2;
    while (triangle + 1 < triangles.size() && triangles[triangle].area_end_m2 <= at_m2) ++triangle;
    const std::size_t index = static_cast<std::size_t>(set) * places.size() + piece;
    result.points.push_back({point_within(triangles[triangle], r2_sequence(index)),
                             triangles[triangle].index, static_cast<int>(places[piece])});
  }
  return result;
}

}  // namespace renderers::shadow_maps
