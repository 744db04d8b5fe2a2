#include "renderers/scene/primitives.h"

#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace renderers::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kDefaultSegments = 32;
constexpr int kMaxSegments = 4096;
const std::array<std::string, 6> kSideNames{"+x", "-x", "+y", "-y", "+z", "-z"};

int read_segments(base::MapReader& reader, int low) {
  const base::Node* node = reader.find("segments");
  return node == nullptr ? kDefaultSegments : read_count(*node, "segments", low, kMaxSegments);
}

bool read_faces_inward(base::MapReader& reader) {
  const base::Node* node = reader.find("facing");
  if (node == nullptr) return false;
  const std::string& facing = node->text("facing");
  if (facing != "in" && facing != "out") {
    throw base::InputError(node->place(),
                           fmt::format("facing \"{}\" is unknown; known: out, in", facing));
  }
  return facing == "in";
}

void turn_inside_out(Mesh& mesh) {
  for (glm::uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
  for (glm::vec3& normal : mesh.normals) normal = -normal;
}

/// A parallelogram of (columns x rows) quads, each of two triangles.
struct Parallelogram {
  glm::vec3 origin;
  glm::vec3 u;
  glm::vec3 v;
  int columns = 1;
  int rows = 1;
};

/// Normals only if it is cut into several quads: one flat quad needs none.
void add_quad(Mesh& mesh, const Parallelogram& quad) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const auto columns = static_cast<unsigned>(quad.columns);
  const auto rows = static_cast<unsigned>(quad.rows);
  const glm::vec3 normal = glm::normalize(glm::cross(quad.u, quad.v));
  // Rows of vertices run to and fro, so that those of a single quad go around it.
  const auto column_at = [&](unsigned i, unsigned j) { return j % 2 == 0 ? i : columns - i; };
  for (unsigned j = 0; j <= rows; ++j) {
    for (unsigned i = 0; i <= columns; ++i) {
      const glm::vec2 uv(static_cast<float>(column_at(i, j)) / static_cast<float>(columns),
                         static_cast<float>(j) / static_cast<float>(rows));
      mesh.positions.push_back(quad.origin + uv.x * quad.u + uv.y * quad.v);
      mesh.uvs.push_back(uv);
      if (columns * rows > 1) mesh.normals.push_back(normal);
    }
  }
  const auto vertex = [&](unsigned i, unsigned j) {
    return first + j * (columns + 1) + column_at(i, j);
  };
  for (unsigned j = 0; j < rows; ++j) {
    for (unsigned i = 0; i < columns; ++i) {
      mesh.triangles.emplace_back(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      mesh.triangles.emplace_back(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
}

/// One number for both edges, or [u, v].
glm::ivec2 read_quad_segments(base::MapReader& reader) {
  const base::Node* node = reader.find("segments");
  if (node == nullptr) return {1, 1};
  if (!node->is_list()) return glm::ivec2(read_count(*node, "segments", 1, kMaxSegments));
  const auto& list = node->list("segments");
  if (list.size() != 2) {
    throw base::InputError(
        node->place(), fmt::format("segments has {} numbers; give one, or [u, v]", list.size()));
  }
  return {read_count(list[0], "segments", 1, kMaxSegments),
          read_count(list[1], "segments", 1, kMaxSegments)};
}

/// The sides of a box that `omit` names, in the order of kSideNames.
std::array<bool, 6> read_omitted_sides(base::MapReader& reader) {
  std::array<bool, 6> omitted{};
  const base::Node* node = reader.find("omit");
  if (node == nullptr) return omitted;
  for (const base::Node& entry : node->list("omit")) {
    const std::string& name = entry.text("a side of omit");
    const auto side = std::ranges::find(kSideNames, name);
    if (side == kSideNames.end()) {
      throw base::InputError(entry.place(), base::unknown_name("side of a box", name, kSideNames));
    }
    omitted[static_cast<std::size_t>(side - kSideNames.begin())] = true;
  }
  if (std::ranges::count(omitted, false) == 0) {
    throw base::InputError(node->place(), "omit leaves no side of the box");
  }
  return omitted;
}

void add_sphere_vertex(Mesh& mesh, const glm::vec3& center, float radius, const glm::vec2& uv) {
  const float azimuth = 2.0F * kPi * uv.x;
  const float polar = kPi * (1.0F - uv.y);
  const glm::vec3 normal(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                         std::sin(polar) * std::cos(azimuth));
  mesh.positions.push_back(center + radius * normal);
  mesh.normals.push_back(normal);
  mesh.uvs.push_back(uv);
}

/// A grid of (segments + 1) x (rings + 1) vertices; the rows at the poles give one triangle each.
Mesh sphere_mesh(const glm::vec3& center, float radius, int segments) {
  Mesh mesh;
  const int rings = std::max(2, segments / 2);
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i <= segments; ++i) {
      add_sphere_vertex(mesh, center, radius,
                        {static_cast<float>(i) / static_cast<float>(segments),
                         static_cast<float>(j) / static_cast<float>(rings)});
    }
  }
  const auto index = [&](int i, int j) { return static_cast<unsigned>(j * (segments + 1) + i); };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < segments; ++i) {
      if (j > 0) mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
      if (j + 1 < rings) {
        mesh.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
      }
    }
  }
  return mesh;
}

}  // namespace

Mesh read_quad(const base::Node& node) {
  base::MapReader reader(node, "quad");
  const glm::vec3 origin = read_vec3(reader.require("origin"), "origin");
  const glm::vec3 u = read_vec3(reader.require("edge_u"), "edge_u");
  const glm::vec3 v = read_vec3(reader.require("edge_v"), "edge_v");
  const glm::ivec2 segments = read_quad_segments(reader);
  reader.finish();
  if (glm::length(glm::cross(u, v)) == 0.0F) {
    throw base::InputError(node.place(), "edge_u and edge_v of a quad must not be parallel");
  }
  Mesh mesh;
  add_quad(mesh, {origin, u, v, segments.x, segments.y});
  return mesh;
}

Mesh read_polygons(const base::Node& node) {
  Mesh mesh;
  for (const base::Node& polygon : node.list("polygons")) {
    const auto& corners = polygon.list("a polygon");
    if (corners.size() < 3) {
      throw base::InputError(polygon.place(),
                             fmt::format("a polygon has {} corners; at least 3", corners.size()));
    }
    const auto first = static_cast<unsigned>(mesh.positions.size());
    for (const base::Node& corner : corners)
      mesh.positions.push_back(read_vec3(corner, "a corner"));
    for (unsigned i = 2; i < corners.size(); ++i) {
      mesh.triangles.emplace_back(first, first + i - 1, first + i);
    }
  }
  return mesh;
}

Mesh read_box(const base::Node& node) {
  base::MapReader reader(node, "box");
  const glm::vec3 low = read_vec3(reader.require("min"), "min");
  const glm::vec3 high = read_vec3(reader.require("max"), "max");
  const bool faces_inward = read_faces_inward(reader);
  const std::array<bool, 6> omitted = read_omitted_sides(reader);
  const base::Node* segments_node = reader.find("segments");
  const int segments =
      segments_node == nullptr ? 1 : read_count(*segments_node, "segments", 1, kMaxSegments);
  reader.finish();
  const glm::vec3 size = high - low;
  if (!(size.x > 0.0F && size.y > 0.0F && size.z > 0.0F)) {
    throw base::InputError(node.place(), "min of a box must be less than max in x, y and z");
  }
  const glm::vec3 x(size.x, 0.0F, 0.0F);
  const glm::vec3 y(0.0F, size.y, 0.0F);
  const glm::vec3 z(0.0F, 0.0F, size.z);
  Mesh mesh;
  const std::array<Parallelogram, 6> sides{{{high - y, -z, y, segments, segments},
                                            {low, z, y, segments, segments},
                                            {low + y + z, x, -z, segments, segments},
                                            {low, x, z, segments, segments},
                                            {low + z, x, y, segments, segments},
                                            {low + x, -x, y, segments, segments}}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!omitted[i]) add_quad(mesh, sides[i]);
  }
  if (faces_inward) turn_inside_out(mesh);
  return mesh;
}

Mesh read_sphere(const base::Node& node) {
  base::MapReader reader(node, "sphere");
  const glm::vec3 center = read_vec3(reader.require("center"), "center");
  const float radius = read_positive(reader.require("radius"), "radius");
  const int segments = read_segments(reader, 4);
  const bool faces_inward = read_faces_inward(reader);
  reader.finish();
  Mesh mesh = sphere_mesh(center, radius, segments);
  if (faces_inward) turn_inside_out(mesh);
  return mesh;
}

Mesh read_disk(const base::Node& node) {
  base::MapReader reader(node, "disk");
  const glm::vec3 center = read_vec3(reader.require("center"), "center");
  const glm::vec3 normal = read_direction(reader.require("normal"), "normal");
  const float radius = read_positive(reader.require("radius"), "radius");
  const int segments = read_segments(reader, 3);
  reader.finish();
  const glm::vec3 helper =
      std::abs(normal.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
  const glm::vec3 u = glm::normalize(glm::cross(helper, normal));
  const glm::vec3 v = glm::cross(normal, u);
  Mesh mesh;
  mesh.positions.push_back(center);
  mesh.uvs.emplace_back(0.5F, 0.5F);
  const auto count = static_cast<unsigned>(segments);
  for (unsigned i = 0; i < count; ++i) {
    const float angle = 2.0F * kPi * static_cast<float>(i) / static_cast<float>(segments);
    const glm::vec2 rim(std::cos(angle), std::sin(angle));
    mesh.positions.push_back(center + radius * (rim.x * u + rim.y * v));
    mesh.uvs.push_back(0.5F + 0.5F * rim);
    mesh.triangles.emplace_back(0U, 1U + i, 1U + (i + 1U) % count);
  }
  return mesh;
}

}  // namespace renderers::scene
