#include "renderers/scene/generators/marching_cubes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace renderers::scene {
namespace {

/// Closest a vertex comes to a grid point, as a part of the edge.
constexpr float kMargin = 0.02F;

/// Corner i lies at bits 0, 1, 2 of i along x, y, z. Edges are named by their two corners.
struct CubeEdge {
  int low;
  int high;
};
constexpr std::array<CubeEdge, 12> kEdges{{{0, 1},
                                           {2, 3},
                                           {4, 5},
                                           {6, 7},
                                           {0, 2},
                                           {1, 3},
                                           {4, 6},
                                           {5, 7},
                                           {0, 4},
                                           {1, 5},
                                           {2, 6},
                                           {3, 7}}};

/// Corners of the six faces, counter-clockwise seen from outside.
constexpr std::array<std::array<int, 4>, 6> kFaces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

int edge_between(int a, int b) {
  for (int edge = 0; edge < 12; ++edge) {
    const CubeEdge& e = kEdges[static_cast<std::size_t>(edge)];
    if ((e.low == a && e.high == b) || (e.low == b && e.high == a)) return edge;
  }
  return -1;
}

/// True if both edges lie in one face of the cube.
bool share_face(int edge_a, int edge_b) {
  const CubeEdge& a = kEdges[static_cast<std::size_t>(edge_a)];
  const CubeEdge& b = kEdges[static_cast<std::size_t>(edge_b)];
  return std::ranges::any_of(kFaces, [&](const std::array<int, 4>& face) {
    const auto has = [&](int corner) { return std::ranges::count(face, corner) > 0; };
    return has(a.low) && has(a.high) && has(b.low) && has(b.high);
  });
}

/// Closed polygon through cut edges; drawn as a fan from its first vertex, or around its middle.
struct Polygon {
  std::vector<int> edges;
  bool has_middle = false;
};

/// The polygons of one case: bit i is set if corner i is inside.
std::vector<Polygon> polygons_of(unsigned inside) {
  const auto is_inside = [&](int corner) { return ((inside >> corner) & 1U) != 0; };
  // On each face, counter-clockwise from outside the cube: a segment runs from where the rim enters
  // the inside to where it leaves it next, so that opposite corners stay apart. Seen from outside
  // the surface the segments close to counter-clockwise polygons.
  std::map<int, int> next;
  for (const auto& face : kFaces) {
    for (std::size_t i = 0; i < 4; ++i) {
      const int a = face[i];
      const int b = face[(i + 1) % 4];
      if (is_inside(a) || !is_inside(b)) continue;
      std::size_t k = i + 1;
      while (is_inside(face[(k + 1) % 4])) ++k;
      next[edge_between(a, b)] = edge_between(face[k % 4], face[(k + 1) % 4]);
    }
  }
  std::vector<Polygon> polygons;
  while (!next.empty()) {
    Polygon polygon;
    for (auto step = next.begin(); step != next.end(); step = next.find(polygon.edges.back())) {
      const int to = step->second;
      next.erase(step);
      polygon.edges.push_back(to);
    }
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

/// Turns the polygon so that no diagonal of its fan lies in a face, where the neighbouring cube
/// might have the same.
void choose_fan(Polygon& polygon) {
  const std::size_t count = polygon.edges.size();
  for (std::size_t turn = 0; turn < count; ++turn) {
    const auto& e = polygon.edges;
    bool is_free = true;
    for (std::size_t i = 2; i + 1 < count; ++i) is_free = is_free && !share_face(e[0], e[i]);
    if (is_free) return;
    std::ranges::rotate(polygon.edges, polygon.edges.begin() + 1);
  }
  polygon.has_middle = true;
}

std::array<std::vector<Polygon>, 256> all_cases() {
  std::array<std::vector<Polygon>, 256> cases;
  for (unsigned inside = 0; inside < 256; ++inside) {
    cases[inside] = polygons_of(inside);
    for (Polygon& polygon : cases[inside]) choose_fan(polygon);
  }
  return cases;
}

glm::ivec3 corner_offset(int corner) { return {corner & 1, (corner >> 1) & 1, corner >> 2}; }

class Surface {
 public:
  Surface(const ScalarGrid& grid, float level)
      : grid_(grid), level_(level), vertices_(3 * grid.values.size(), kNoVertex) {}

  Mesh build() {
    const auto cases = all_cases();
    glm::ivec3 cell(0);
    for (cell.z = 0; cell.z + 1 < grid_.points.z; ++cell.z) {
      for (cell.y = 0; cell.y + 1 < grid_.points.y; ++cell.y) {
        for (cell.x = 0; cell.x + 1 < grid_.points.x; ++cell.x) {
          for (const Polygon& polygon : cases[case_of(cell)]) add_polygon(cell, polygon);
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kNoVertex = 0xFFFFFFFFU;

  float value_at(const glm::ivec3& p) const { return grid_.values[grid_.index(p)]; }

  std::size_t case_of(const glm::ivec3& cell) const {
    std::size_t inside = 0;
    for (int corner = 0; corner < 8; ++corner) {
      if (value_at(cell + corner_offset(corner)) > level_) inside |= std::size_t{1} << corner;
    }
    return inside;
  }

  /// The vertex on an edge of a cell, shared by the cells around the edge.
  std::uint32_t vertex_on(const glm::ivec3& cell, int edge) {
    const CubeEdge& ends = kEdges[static_cast<std::size_t>(edge)];
    const glm::ivec3 low = cell + corner_offset(ends.low);
    const glm::ivec3 high = cell + corner_offset(ends.high);
    const glm::ivec3 along = high - low;
    const std::size_t axis = along.x != 0 ? 0 : (along.y != 0 ? 1 : 2);
    std::uint32_t& vertex = vertices_[3 * grid_.index(low) + axis];
    if (vertex != kNoVertex) return vertex;
    const float a = value_at(low);
    const float t = std::clamp((level_ - a) / (value_at(high) - a), kMargin, 1.0F - kMargin);
    vertex = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(grid_.origin +
                              grid_.step_m * (glm::vec3(low) + t * glm::vec3(along)));
    return vertex;
  }

  void add_polygon(const glm::ivec3& cell, const Polygon& polygon) {
    std::vector<std::uint32_t> ring;
    for (const int edge : polygon.edges) ring.push_back(vertex_on(cell, edge));
    if (!polygon.has_middle) {
      for (std::size_t i = 2; i < ring.size(); ++i) {
        mesh_.triangles.emplace_back(ring[0], ring[i - 1], ring[i]);
      }
      return;
    }
    glm::vec3 middle(0.0F);
    for (const std::uint32_t vertex : ring) middle += mesh_.positions[vertex];
    const auto center = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(middle / static_cast<float>(ring.size()));
    for (std::size_t i = 0; i < ring.size(); ++i) {
      mesh_.triangles.emplace_back(center, ring[i], ring[(i + 1) % ring.size()]);
    }
  }

  const ScalarGrid& grid_;
  float level_;
  std::vector<std::uint32_t> vertices_;  ///< on the three edges that start at each grid point
  Mesh mesh_;
};

}  // namespace

Mesh marching_cubes(const ScalarGrid& grid, float level) { return Surface(grid, level).build(); }

}  // namespace renderers::scene
