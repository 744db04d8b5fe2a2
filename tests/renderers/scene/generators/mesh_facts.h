#pragma once

#include "renderers/scene/scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

/// Facts about meshes, computed in double precision.
namespace tests {

using renderers::scene::Mesh;

inline glm::dvec3 area_vector(const Mesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a(mesh.positions[t.x]);
  return 0.5 * glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
}

inline double area_m2(const Mesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) sum += glm::length(area_vector(mesh, t));
  return sum;
}

/// Positive if the front is outside (divergence theorem).
inline double volume_m3(const Mesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    sum += glm::dot(glm::dvec3(mesh.positions[t.x]), area_vector(mesh, t)) / 3.0;
  }
  return sum;
}

/// Least height of a triangle over its longest edge.
inline double least_relative_height(const Mesh& mesh) {
  double least = 1.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]);
    const glm::dvec3 b(mesh.positions[t.y]);
    const glm::dvec3 c(mesh.positions[t.z]);
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    least = std::min(least, 2.0 * glm::length(area_vector(mesh, t)) / (longest * longest));
  }
  return least;
}

/// Edges that are not run through exactly once in each direction; 0: closed, all fronts outside.
inline int open_edges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const glm::uvec3& t : mesh.triangles) {
    ++runs[{t.x, t.y}];
    ++runs[{t.y, t.z}];
    ++runs[{t.z, t.x}];
  }
  int open = 0;
  for (const auto& [edge, count] : runs) {
    const auto back = runs.find({edge.second, edge.first});
    if (count != 1 || back == runs.end() || back->second != 1) ++open;
  }
  return open;
}

/// Corners whose normal points to the back of their triangle.
inline int turned_normals(const Mesh& mesh) {
  int turned = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      if (glm::dot(area_vector(mesh, t), glm::dvec3(mesh.normals[t[corner]])) <= 0.0) ++turned;
    }
  }
  return turned;
}

}  // namespace tests
