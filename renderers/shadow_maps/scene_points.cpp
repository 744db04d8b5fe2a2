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
  int object;          ///< among the scene's
  int own_index;       ///< among the object's
  double area_end_m2;  ///< sum of the areas up to this triangle
};

/// Corners in world space, m.
void place_triangle(const scene::Object& object, std::size_t index, glm::vec3 (&vertex)[3]) {
  const glm::uvec3& corner = object.mesh->triangles[index];
  for (int i = 0; i < 3; ++i) {
    vertex[i] = glm::vec3(object.to_world * glm::vec4(object.mesh->positions[corner[i]], 1.0F));
  }
}

/// Twice the area long, towards the front.
glm::vec3 scaled_normal(const glm::vec3 (&vertex)[3]) {
  return glm::cross(vertex[1] - vertex[0], vertex[2] - vertex[0]);
}

std::vector<WorldTriangle> triangles_with_area(const scene::Scene& scene) {
  std::vector<WorldTriangle> triangles;
  double area_m2 = 0.0;
  int next = 0;
  for (std::size_t own = 0; own < scene.objects.size(); ++own) {
    const scene::Object& object = scene.objects[own];
    for (std::size_t index = 0; index < object.mesh->triangles.size(); ++index) {
      WorldTriangle triangle{};
      triangle.index = next++;
      triangle.object = static_cast<int>(own);
      triangle.own_index = static_cast<int>(index);
      place_triangle(object, index, triangle.vertex);
      const glm::vec3 scaled = scaled_normal(triangle.vertex);
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

glm::vec3 point_at(const glm::vec3 (&vertex)[3], const glm::vec2& weight) {
  return vertex[0] + weight.x * (vertex[1] - vertex[0]) + weight.y * (vertex[2] - vertex[0]);
}

glm::vec3 point_within(const WorldTriangle& triangle, const glm::dvec2& u) {
  return point_at(triangle.vertex, ray_tracing::uniform_triangle(glm::vec2(u)));
}

}  // namespace

DealtPoints::DealtPoints(const scene::Scene& scene, int sets, int points_per_set) {
  for (const scene::Object& object : scene.objects) triangles_.push_back(object.mesh->triangles);
  const std::vector<WorldTriangle> triangles = triangles_with_area(scene);
  if (triangles.empty()) return;
  const double area_m2 = triangles.back().area_end_m2;
  const auto radius_m =
      static_cast<float>(std::sqrt(area_m2 / (std::numbers::pi * points_per_set)));

  const std::vector<std::size_t> order = radical_order(sets);
  const auto per_set = static_cast<std::size_t>(points_per_set);
  points_.resize(order.size() * per_set);
  places_.resize(points_.size());
  std::size_t at = 0;
  for (std::size_t piece = 0; piece < points_.size(); ++piece) {
    const double at_m2 =
        (static_cast<double>(piece) + 0.5) / static_cast<double>(points_.size()) * area_m2;
    while (at + 1 < triangles.size() && triangles[at].area_end_m2 <= at_m2) ++at;
    const WorldTriangle& triangle = triangles[at];
    const std::size_t index = order[piece % order.size()] * per_set + piece / order.size();
    const glm::vec2 weight = ray_tracing::uniform_triangle(glm::vec2(r2_sequence(index)));
    points_[index] = {glm::vec4(point_at(triangle.vertex, weight), radius_m),
                      glm::vec4(triangle.normal, 0.0F)};
    places_[index] = {triangle.object, triangle.own_index, weight};
  }
}

std::size_t DealtPoints::move(const scene::Scene& scene) {
  std::vector<bool> is_kept(triangles_.size(), false);
  for (std::size_t i = 0; i < std::min(triangles_.size(), scene.objects.size()); ++i) {
    is_kept[i] = scene.objects[i].mesh->triangles == triangles_[i];
  }
  std::size_t left_behind = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Place& place = places_[i];
    const auto own = static_cast<std::size_t>(place.object);
    if (!is_kept[own]) {
      ++left_behind;
      continue;
    }
    glm::vec3 vertex[3];
    place_triangle(scene.objects[own], static_cast<std::size_t>(place.triangle), vertex);
    const glm::vec3 scaled = scaled_normal(vertex);
    const float length = glm::length(scaled);
    points_[i].position = glm::vec4(point_at(vertex, place.weight), points_[i].position.w);
    // A triangle that has shrunk to nothing keeps the direction that it had.
    if (length > 0.0F) points_[i].normal = glm::vec4(scaled / length, 0.0F);
  }
  return left_behind;
}

std::vector<ScenePoint> scene_points(const scene::Scene& scene, int sets, int points_per_set) {
  return DealtPoints(scene, sets, points_per_set).points();
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
