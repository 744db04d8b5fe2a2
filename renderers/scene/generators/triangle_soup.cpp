#include "renderers/scene/generators/triangle_soup.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace renderers::scene {
namespace {

/// Smallest height of a triangle over its longest edge.
constexpr float kMinRelativeHeight = 1e-4F;

bool has_area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  return glm::length(glm::cross(b - a, c - a)) > kMinRelativeHeight * longest * longest;
}

/// Coordinates on the axis plane that the face is most parallel to.
glm::vec2 planar_uv(const glm::vec3& position, const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const glm::vec3 p = position / kTexturePeriod_m;
  if (size.y >= size.x && size.y >= size.z) return {p.x, p.z};
  return size.x >= size.z ? glm::vec2(p.z, p.y) : glm::vec2(p.x, p.y);
}

using PositionKey = std::tuple<float, float, float>;

PositionKey key_of(const glm::vec3& p) { return {p.x, p.y, p.z}; }

/// A face at a position.
struct FaceCorner {
  glm::vec3 normal;
  float angle_rad;
};

class CreaseNormals {
 public:
  CreaseNormals(const std::vector<Corner>& corners, float crease_deg)
      : corners_(corners), cos_crease_(std::cos(glm::radians(crease_deg))) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [entry, is_new] = groups_.emplace(key_of(corners[i].position), faces_.size());
      if (is_new) faces_.emplace_back();
      group_of_.push_back(entry->second);
      faces_[entry->second].push_back(face_corner(i));
    }
  }

  glm::vec3 normal_of(std::size_t corner) const {
    const glm::vec3 own = face_corner(corner).normal;
    glm::vec3 sum(0.0F);
    for (const FaceCorner& face : faces_[group_of_[corner]]) {
      if (glm::dot(face.normal, own) >= cos_crease_) sum += face.angle_rad * face.normal;
    }
    return glm::normalize(sum);
  }

 private:
  FaceCorner face_corner(std::size_t corner) const {
    const std::size_t first = corner - corner % 3;
    const auto at = [&](std::size_t i) { return corners_[first + i % 3].position; };
    const std::size_t own = corner % 3;
    const glm::vec3 to_next = glm::normalize(at(own + 1) - at(own));
    const glm::vec3 to_last = glm::normalize(at(own + 2) - at(own));
    return {glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0))),
            std::acos(std::clamp(glm::dot(to_next, to_last), -1.0F, 1.0F))};
  }

  const std::vector<Corner>& corners_;
  float cos_crease_;
  std::map<PositionKey, std::size_t> groups_;
  std::vector<std::size_t> group_of_;           ///< per corner
  std::vector<std::vector<FaceCorner>> faces_;  ///< per group
};

}  // namespace

void TriangleSoup::add_triangle(const Corner& a, const Corner& b, const Corner& c) {
  if (has_area(a.position, b.position, c.position)) corners_.insert(corners_.end(), {a, b, c});
}

void TriangleSoup::add_quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  add_triangle(a, b, c);
  add_triangle(a, c, d);
}

void TriangleSoup::add_polygon(const std::vector<glm::vec3>& corners) {
  const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const auto corner = [&](std::size_t i) {
    return Corner{corners[i], planar_uv(corners[i], normal)};
  };
  for (std::size_t i = 2; i < corners.size(); ++i) {
    add_triangle(corner(0), corner(i - 1), corner(i));
  }
}

void TriangleSoup::add_box(const glm::vec3& least, const glm::vec3& greatest, unsigned open_sides) {
  // Corner i takes x, y, z from `greatest` where bit 0, 1, 2 of i is set.
  const auto corner = [&](unsigned i) {
    return glm::vec3((i & 1U) != 0 ? greatest.x : least.x, (i & 2U) != 0 ? greatest.y : least.y,
                     (i & 4U) != 0 ? greatest.z : least.z);
  };
  struct Side {
    BoxSide side;
    std::array<unsigned, 4> corners;
  };
  constexpr std::array<Side, 6> kSides{{{kLeastX, {0, 4, 6, 2}},
                                        {kGreatestX, {5, 1, 3, 7}},
                                        {kLeastY, {0, 1, 5, 4}},
                                        {kGreatestY, {6, 7, 3, 2}},
                                        {kLeastZ, {1, 0, 2, 3}},
                                        {kGreatestZ, {4, 5, 7, 6}}}};
  for (const Side& side : kSides) {
    if ((open_sides & side.side) != 0) continue;
    const auto& c = side.corners;
    add_polygon({corner(c[0]), corner(c[1]), corner(c[2]), corner(c[3])});
  }
}

void TriangleSoup::add_grid(int columns, int rows, const std::function<Corner(int, int)>& point) {
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      add_quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
    }
  }
}

void TriangleSoup::append(const TriangleSoup& other, const glm::mat4& to_place) {
  for (const Corner& corner : other.corners_) {
    corners_.push_back({glm::vec3(to_place * glm::vec4(corner.position, 1.0F)), corner.uv});
  }
}

Mesh TriangleSoup::to_mesh(float crease_deg) const {
  using VertexKey = std::array<float, 8>;
  const CreaseNormals normals(corners_, crease_deg);
  std::map<VertexKey, std::uint32_t> known;
  std::vector<std::uint32_t> indices;
  Mesh mesh;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const glm::vec3 p = corners_[i].position;
    const glm::vec2 uv = corners_[i].uv;
    const glm::vec3 n = normals.normal_of(i);
    const auto next = static_cast<std::uint32_t>(mesh.positions.size());
    const auto [entry, is_new] =
        known.emplace(VertexKey{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}, next);
    indices.push_back(entry->second);
    if (!is_new) continue;
    mesh.positions.push_back(p);
    mesh.normals.push_back(n);
    mesh.uvs.push_back(uv);
  }
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    mesh.triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
  }
  return mesh;
}

}  // namespace renderers::scene
