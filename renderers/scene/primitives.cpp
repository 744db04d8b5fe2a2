#include "renderers/scene/primitives.h"

#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace renderers::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kDefaultSegments = 32;
constexpr int kMaxSegments = 4096;

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

void add_quad(Mesh& mesh, const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {origin, origin + u, origin + u + v, origin + v});
  mesh.uvs.insert(mesh.uvs.end(), {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
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
  reader.finish();
  if (glm::length(glm::cross(u, v)) == 0.0F) {
    throw base::InputError(node.place(), "edge_u and edge_v of a quad must not be parallel");
  }
  Mesh mesh;
  add_quad(mesh, origin, u, v);
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
  reader.finish();
  const glm::vec3 size = high - low;
  if (!(size.x > 0.0F && size.y > 0.0F && size.z > 0.0F)) {
    throw base::InputError(node.place(), "min of a box must be less than max in x, y and z");
  }
  const glm::vec3 x(size.x, 0.0F, 0.0F);
  const glm::vec3 y(0.0F, size.y, 0.0F);
  const glm::vec3 z(0.0F, 0.0F, size.z);
  Mesh mesh;
  add_quad(mesh, high - y, -z, y);     // +x
  add_quad(mesh, low, z, y);           // -x
  add_quad(mesh, low + y + z, x, -z);  // +y
  add_quad(mesh, low, x, z);           // -y
  add_quad(mesh, low + z, x, y);       // +z
  add_quad(mesh, low + x, -x, y);      // -z
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
