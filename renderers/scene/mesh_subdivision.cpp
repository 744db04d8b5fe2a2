#include "renderers/scene/mesh_subdivision.h"

#include "renderers/scene/mesh_repair.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <queue>
#include <utility>
#include <vector>

namespace renderers::scene {
namespace {

/// The numbers of two positions or the indices of two vertices, the smaller one first.
using Pair = std::pair<std::size_t, std::size_t>;

Pair ordered(std::size_t a, std::size_t b) { return a < b ? Pair(a, b) : Pair(b, a); }

/// An edge that waits to be halved.
struct Edge {
  double square_m2;  ///< of its length
  Pair positions;

  /// The longest edge, then the one of the earlier positions, is the greatest.
  bool operator<(const Edge& other) const {
    if (square_m2 != other.square_m2) return square_m2 < other.square_m2;
    return positions > other.positions;
  }
};

class Subdivision {
 public:
  explicit Subdivision(Mesh& mesh) : mesh_(mesh), numbers_(position_numbers(mesh)) {
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      position_count_ = std::max(position_count_, numbers_[i] + 1);
    }
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) add_edges_of(t);
  }

  void halve_longest_edge() {
    const Pair edge = longest_.top().positions;
    longest_.pop();
    const auto found = triangles_of_.find(edge);
    const std::vector<std::size_t> triangles = std::move(found->second);
    triangles_of_.erase(found);
    const std::size_t middle = position_count_++;
    std::map<Pair, unsigned> middles;  // by the vertices of the edge's ends: seams keep two
    for (const std::size_t t : triangles) halve(t, edge, middle, middles);
  }

 private:
  /// Corner i, such that the edge runs from it to the next corner.
  int corner_before(const glm::uvec3& t, const Pair& edge) const {
    int i = 0;
    while (ordered(numbers_[t[i]], numbers_[t[(i + 1) % 3]]) != edge) ++i;
    return i;
  }

  void halve(std::size_t triangle, const Pair& edge, std::size_t middle,
             std::map<Pair, unsigned>& middles) {
    const glm::uvec3 old = mesh_.triangles[triangle];
    const int i = corner_before(old, edge);
    const unsigned from = old[i];
    const unsigned to = old[(i + 1) % 3];
    const unsigned apex = old[(i + 2) % 3];
    const auto [known, is_new] = middles.try_emplace(ordered(from, to), 0U);
    if (is_new) known->second = add_middle(from, to, middle);
    const std::size_t second = mesh_.triangles.size();
    mesh_.triangles[triangle] = {from, known->second, apex};
    mesh_.triangles.push_back({known->second, to, apex});
    replace(ordered(numbers_[to], numbers_[apex]), triangle, second);
    add_edge(from, known->second, triangle);
    add_edge(known->second, to, second);
    add_edge(known->second, apex, triangle);
    add_edge(known->second, apex, second);
  }

  unsigned add_middle(unsigned a, unsigned b, std::size_t number) {
    mesh_.positions.push_back(0.5F * (mesh_.positions[a] + mesh_.positions[b]));
    if (!mesh_.uvs.empty()) mesh_.uvs.push_back(0.5F * (mesh_.uvs[a] + mesh_.uvs[b]));
    if (!mesh_.normals.empty()) {
      const glm::vec3 sum = mesh_.normals[a] + mesh_.normals[b];
      const float length = glm::length(sum);
      // Opposite normals have no mean: one of them.
      mesh_.normals.push_back(length > 0.0F ? sum / length : mesh_.normals[a]);
    }
    numbers_.push_back(number);
    return static_cast<unsigned>(mesh_.positions.size() - 1);
  }

  void add_edges_of(std::size_t triangle) {
    const glm::uvec3 t = mesh_.triangles[triangle];
    for (int i = 0; i < 3; ++i) add_edge(t[i], t[(i + 1) % 3], triangle);
  }

  /// Every edge waits once, from when its first triangle is known.
  void add_edge(unsigned a, unsigned b, std::size_t triangle) {
    const Pair edge = ordered(numbers_[a], numbers_[b]);
    std::vector<std::size_t>& triangles = triangles_of_[edge];
    if (triangles.empty()) {
      const glm::dvec3 along = glm::dvec3(mesh_.positions[b]) - glm::dvec3(mesh_.positions[a]);
      longest_.push({glm::dot(along, along), edge});
    }
    triangles.push_back(triangle);
  }

  void replace(const Pair& edge, std::size_t old_triangle, std::size_t new_triangle) {
    for (std::size_t& t : triangles_of_[edge]) {
      if (t == old_triangle) t = new_triangle;
    }
  }

  Mesh& mesh_;
  std::vector<std::size_t> numbers_;  ///< of the vertices' positions
  std::size_t position_count_ = 0;
  std::map<Pair, std::vector<std::size_t>> triangles_of_;
  std::priority_queue<Edge> longest_;
};

}  // namespace

void subdivide_to(Mesh& mesh, std::size_t triangles) {
  if (mesh.triangles.empty() || mesh.triangles.size() >= triangles) return;
  Subdivision subdivision(mesh);
  while (mesh.triangles.size() < triangles) subdivision.halve_longest_edge();
}

}  // namespace renderers::scene
