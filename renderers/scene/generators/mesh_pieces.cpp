#include "renderers/scene/generators/mesh_pieces.h"

#include "renderers/scene/generators/triangle_soup.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

/// Height of a rounded spine's arc over its chord; ours.
constexpr float kSpineRise = 0.3F;

glm::vec3 placed(const glm::mat4& to_place, const glm::vec3& point) {
  return glm::vec3(to_place * glm::vec4(point, 1.0F));
}

void add_vertex(Mesh& mesh, const glm::vec3& position, const glm::vec3& normal,
                const glm::vec2& uv) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  mesh.uvs.push_back(uv);
}

/// Points of a book's outline in x and z: back left, along the spine, back right.
std::vector<glm::vec2> outline(const BookShape& shape) {
  const float half_m = 0.5F * shape.thickness_m;
  std::vector<glm::vec2> points{{-half_m, 0.0F}};
  for (int i = 0; i <= shape.spine_segments; ++i) {
    const float angle_rad = std::numbers::pi_v<float> * static_cast<float>(i) /
                            static_cast<float>(shape.spine_segments);
    points.emplace_back(-half_m * std::cos(angle_rad),
                        shape.depth_m + kSpineRise * half_m * std::sin(angle_rad));
  }
  points.emplace_back(half_m, 0.0F);
  return points;
}

/// The outline's polygon at a height as a fan. @param up  1: front above, -1: below
void add_end(Mesh& mesh, const std::vector<glm::vec2>& points, float height_m, float up,
             const glm::mat4& to_place) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const glm::vec3 normal = glm::mat3(to_place) * glm::vec3(0.0F, up, 0.0F);
  for (const glm::vec2& p : points) {
    add_vertex(mesh, placed(to_place, {p.x, height_m, p.y}), normal, p / kTexturePeriod_m);
  }
  for (unsigned i = 1; i + 1 < points.size(); ++i) {
    if (up > 0.0F) {
      mesh.triangles.emplace_back(first, first + i, first + i + 1);
    } else {
      mesh.triangles.emplace_back(first, first + i + 1, first + i);
    }
  }
}

}  // namespace

void add_parallelogram(Mesh& mesh, const glm::vec3& corner, const glm::vec3& a,
                       const glm::vec3& b) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(a, b));
  const float u = glm::length(a) / kTexturePeriod_m;
  const float v = glm::length(b) / kTexturePeriod_m;
  add_vertex(mesh, corner, normal, {0.0F, 0.0F});
  add_vertex(mesh, corner + a, normal, {u, 0.0F});
  add_vertex(mesh, corner + a + b, normal, {u, v});
  add_vertex(mesh, corner + b, normal, {0.0F, v});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
}

void add_cuboid(Mesh& mesh, const glm::vec3& least, const glm::vec3& greatest,
                const glm::mat4& to_place) {
  const glm::mat3 turn(to_place);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 a(0.0F);
    glm::vec3 b(0.0F);
    a[(axis + 1) % 3] = greatest[(axis + 1) % 3] - least[(axis + 1) % 3];
    b[(axis + 2) % 3] = greatest[(axis + 2) % 3] - least[(axis + 2) % 3];
    glm::vec3 far = least;
    far[axis] = greatest[axis];
    add_parallelogram(mesh, placed(to_place, least), turn * b, turn * a);
    add_parallelogram(mesh, placed(to_place, far), turn * a, turn * b);
  }
}

void add_ellipsoid(Mesh& mesh, const glm::vec3& center, const glm::vec3& radii_m, int segments) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const int rows = segments / 2;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= segments; ++column) {
      const glm::vec2 uv(static_cast<float>(column) / static_cast<float>(segments),
                         static_cast<float>(row) / static_cast<float>(rows));
      const float polar_rad = std::numbers::pi_v<float> * uv.y;
      const float azimuth_rad = 2.0F * std::numbers::pi_v<float> * uv.x;
      const glm::vec3 unit(std::sin(polar_rad) * std::sin(azimuth_rad), std::cos(polar_rad),
                           std::sin(polar_rad) * std::cos(azimuth_rad));
      add_vertex(mesh, center + radii_m * unit, glm::normalize(unit / radii_m), uv);
    }
  }
  const auto width = static_cast<unsigned>(segments) + 1;
  for (unsigned row = 0; row < static_cast<unsigned>(rows); ++row) {
    for (unsigned column = 0; column + 1 < width; ++column) {
      const unsigned a = first + row * width + column;
      if (row > 0) mesh.triangles.emplace_back(a, a + width, a + 1);
      if (row + 1 < static_cast<unsigned>(rows)) {
        mesh.triangles.emplace_back(a + 1, a + width, a + width + 1);
      }
    }
  }
}

void add_tube(Mesh& mesh, const TubeShape& shape) {
  const glm::vec3 axis = glm::normalize(shape.to - shape.from);
  const glm::vec3 aside =
      std::fabs(axis.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
  const glm::vec3 u = glm::normalize(glm::cross(aside, axis));
  const glm::vec3 v = glm::cross(axis, u);
  const auto around = static_cast<unsigned>(shape.around);
  const auto direction = [&](unsigned i) {
    const float angle_rad =
        2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(around);
    return std::cos(angle_rad) * u + std::sin(angle_rad) * v;
  };
  const auto first = static_cast<unsigned>(mesh.positions.size());
  for (unsigned i = 0; i <= around; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(around);
    add_vertex(mesh, shape.from + shape.from_radius_m * direction(i), direction(i), {share, 0.0F});
    add_vertex(mesh, shape.to + shape.to_radius_m * direction(i), direction(i), {share, 1.0F});
  }
  for (unsigned i = first; i < first + 2 * around; i += 2) {
    mesh.triangles.emplace_back(i, i + 2, i + 1);
    mesh.triangles.emplace_back(i + 1, i + 2, i + 3);
  }
  if (!shape.has_ends) return;
  for (const bool is_far : {false, true}) {
    const auto middle = static_cast<unsigned>(mesh.positions.size());
    const glm::vec3 center = is_far ? shape.to : shape.from;
    const float radius_m = is_far ? shape.to_radius_m : shape.from_radius_m;
    const glm::vec3 normal = is_far ? axis : -axis;
    add_vertex(mesh, center, normal, {0.5F, 0.5F});
    for (unsigned i = 0; i <= around; ++i) {
      add_vertex(mesh, center + radius_m * direction(i), normal, {0.5F, 0.5F});
    }
    for (unsigned i = middle + 1; i <= middle + around; ++i) {
      if (is_far) {
        mesh.triangles.emplace_back(middle, i, i + 1);
      } else {
        mesh.triangles.emplace_back(middle, i + 1, i);
      }
    }
  }
}

void add_book(Mesh& cover, Mesh& pages, const BookShape& shape, const glm::mat4& to_place) {
  const std::vector<glm::vec2> points = outline(shape);
  const glm::vec3 up = glm::mat3(to_place) * glm::vec3(0.0F, shape.height_m, 0.0F);
  // Outline from left to right as seen from above with +z towards the viewer: fronts outside.
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const glm::vec3 from = placed(to_place, {points[i].x, 0.0F, points[i].y});
    const glm::vec3 to = placed(to_place, {points[i + 1].x, 0.0F, points[i + 1].y});
    add_parallelogram(cover, from, to - from, up);
  }
  const glm::vec3 right = placed(to_place, {points.back().x, 0.0F, points.back().y});
  const glm::vec3 left = placed(to_place, {points.front().x, 0.0F, points.front().y});
  add_parallelogram(pages, right, left - right, up);
  add_end(pages, points, shape.height_m, 1.0F, to_place);
  add_end(pages, points, 0.0F, -1.0F, to_place);
}

}  // namespace renderers::scene
