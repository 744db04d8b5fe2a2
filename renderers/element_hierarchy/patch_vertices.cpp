#include "renderers/element_hierarchy/patch_vertices.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::element_hierarchy {

namespace {

/// Places closer than this share of the scene's diagonal are one.
constexpr float kSamePlace = 1e-5F;
/// Cosine between normals that share a vertex.
constexpr float kSmooth = 0.8F;

/// Finds or makes vertices by place and normal.
class Welder {
 public:
  explicit Welder(float tolerance_m) : tolerance_m_(tolerance_m), cell_m_(8.0F * tolerance_m) {}

  std::uint32_t vertex_at(const glm::vec3& place, const glm::vec3& normal) {
    // Of the cells that the tolerance reaches, nearly always one.
    const glm::ivec3 low = cell_of(place - tolerance_m_);
    const glm::ivec3 high = cell_of(place + tolerance_m_);
    for (int x = low.x; x <= high.x; ++x) {
      for (int y = low.y; y <= high.y; ++y) {
        for (int z = low.z; z <= high.z; ++z) {
          const auto found = cells_.find(key_of({x, y, z}));
          if (found == cells_.end()) continue;
          for (const std::uint32_t vertex : found->second) {
            if (is_same(vertex, place, normal)) return vertex;
          }
        }
      }
    }
    const auto vertex = static_cast<std::uint32_t>(places_.size());
    places_.push_back(place);
    normals_.push_back(normal);
    cells_[key_of(cell_of(place))].push_back(vertex);
    return vertex;
  }
  std::size_t count() const { return places_.size(); }

 private:
  glm::ivec3 cell_of(const glm::vec3& place) const { return glm::floor(place / cell_m_); }
  static std::uint64_t key_of(const glm::ivec3& cell) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      key = ray_tracing::hash_combine(key, static_cast<std::uint32_t>(cell[axis]));
    }
    return key;
  }
  bool is_same(std::uint32_t vertex, const glm::vec3& place, const glm::vec3& normal) const {
    return glm::distance(places_[vertex], place) <= tolerance_m_ &&
           glm::dot(normals_[vertex], normal) > kSmooth;
  }

  float tolerance_m_;
  float cell_m_;
  std::vector<glm::vec3> places_;
  std::vector<glm::vec3> normals_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

std::uint64_t edge_of(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

}  // namespace

PatchVertices::PatchVertices(const ElementTree& tree) {
  const std::vector<Element>& elements = tree.elements();
  Welder welder(std::max(1e-30F, kSamePlace * elements.front().extent_m()));
  corners_.resize(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements[i].is_patch) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      corners_[i][c] = welder.vertex_at(elements[i].positions[c], elements[i].normal);
    }
  }
  areas_m2_.resize(welder.count(), 0.0F);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements[i].is_patch || !elements[i].is_leaf()) continue;
    for (const std::uint32_t vertex : corners_[i]) areas_m2_[vertex] += elements[i].area_m2;
  }
  hanging_at_.assign(welder.count(), kNoElement);
  find_hanging(tree);
}

void PatchVertices::find_hanging(const ElementTree& tree) {
  const std::vector<Element>& elements = tree.elements();
  std::unordered_set<std::uint64_t> whole;         // edges that some leaf has undivided
  std::vector<std::pair<int, std::uint32_t>> cut;  // by level: coarse edges come first
  std::vector<int> level(elements.size(), 0);
  for (std::uint32_t i = 0; i < elements.size(); ++i) {
    if (!elements[i].is_patch) continue;
    const std::uint32_t parent = elements[i].parent;
    if (parent != kNoElement && elements[parent].is_patch) level[i] = level[parent] + 1;
    if (!elements[i].is_leaf()) {
      cut.emplace_back(level[i], i);
      continue;
    }
    const auto& v = corners_[i];
    for (std::size_t c = 0; c < 3; ++c) whole.insert(edge_of(v[c], v[(c + 1) % 3]));
  }
  std::ranges::sort(cut);
  for (const auto& [depth, patch] : cut) {
    const auto& v = corners_[patch];
    // The middle part's corners are the middles of bc, ca, ab.
    const auto& middle = corners_[elements[patch].first_child + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = v[(c + 1) % 3];
      const std::uint32_t b = v[(c + 2) % 3];
      const std::uint32_t m = middle[c];
      if (!whole.contains(edge_of(a, b)) || hanging_at_[m] != kNoElement) continue;
      // Surfaces that overlap can have each other's corners on their edges.
      if (rests_on(a, m) || rests_on(b, m)) continue;
      hanging_at_[m] = static_cast<std::uint32_t>(hanging_.size());
      hanging_.push_back({m, {a, b}});
      whole.insert(edge_of(a, m));
      whole.insert(edge_of(m, b));
    }
  }
}

bool PatchVertices::rests_on(std::uint32_t vertex, std::uint32_t other) const {
  if (vertex == other) return true;
  if (hanging_at_[vertex] == kNoElement) return false;
  const auto& ends = hanging_[hanging_at_[vertex]].ends;
  return rests_on(ends[0], other) || rests_on(ends[1], other);
}

void PatchVertices::add_bearing(std::uint32_t vertex, float weight,
                                std::vector<Weighted>& into) const {
  if (hanging_at_[vertex] == kNoElement) {
    into.push_back({vertex, weight});
    return;
  }
  // No vertex rests on itself, so that this comes to an end.
  for (const std::uint32_t end : hanging_[hanging_at_[vertex]].ends) {
    add_bearing(end, 0.5F * weight, into);
  }
}

std::vector<glm::vec3> PatchVertices::means(const ElementTree& tree,
                                            const std::vector<glm::vec3>& values) const {
  std::vector<glm::vec3> sums(count(), glm::vec3(0.0F));
  for (std::size_t i = 0; i < tree.elements().size(); ++i) {
    const Element& element = tree.elements()[i];
    if (!element.is_patch || !element.is_leaf()) continue;
    for (const std::uint32_t vertex : corners_[i]) sums[vertex] += element.area_m2 * values[i];
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (areas_m2_[v] > 0.0F) sums[v] /= areas_m2_[v];
  }
  for (const Hanging& vertex : hanging_) {
    sums[vertex.vertex] = 0.5F * (sums[vertex.ends[0]] + sums[vertex.ends[1]]);
  }
  return sums;
}

}  // namespace renderers::element_hierarchy
