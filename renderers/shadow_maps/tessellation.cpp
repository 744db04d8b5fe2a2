#include "renderers/shadow_maps/tessellation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unordered_map>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

namespace renderers::shadow_maps {

namespace {

/// Cuts triangles, whose vertices are in the list, into pieces.
class Cutter {
 public:
  Cutter(float limit_m2, std::size_t most, TriangleList& list)
      : limit_m2_(limit_m2), most_(most), list_(list) {}

  /// False if there would be more pieces than allowed.
  bool cut(const glm::uvec3& triangle) {
    if (fewest_pieces(triangle) > static_cast<double>(most_)) return false;
    waiting_.assign(1, triangle);
    while (!waiting_.empty()) {
      const glm::uvec3 piece = waiting_.back();
      waiting_.pop_back();
      const int longest = longest_edge(piece);
      // Every waiting one gives at least one piece.
      const std::size_t least = list_.triangles.size() + waiting_.size() + (longest < 0 ? 1 : 2);
      if (least > most_) return false;
      if (longest < 0) {
        list_.triangles.push_back(piece);
        continue;
      }
      const std::uint32_t a = piece[longest];
      const std::uint32_t b = piece[(longest + 1) % 3];
      const std::uint32_t c = piece[(longest + 2) % 3];
      const std::uint32_t middle = middle_of(a, b);
      waiting_.push_back({a, middle, c});
      waiting_.push_back({middle, b, c});
    }
    return true;
  }

 private:
  /// The largest piece without a longer edge than the limit is equilateral.
  double fewest_pieces(const glm::uvec3& triangle) const {
    const glm::dvec3 a(list_.vertices[triangle.x]);
    const double area_m2 =
        0.5 * glm::length(glm::cross(glm::dvec3(list_.vertices[triangle.y]) - a,
                                     glm::dvec3(list_.vertices[triangle.z]) - a));
    return area_m2 / (0.25 * std::numbers::sqrt3 * static_cast<double>(limit_m2_));
  }

  /// Of those that are too long and can be cut, its first corner; -1 if there is none.
  int longest_edge(const glm::uvec3& piece) const {
    int longest = -1;
    float longest_m2 = limit_m2_;
    for (int i = 0; i < 3; ++i) {
      const glm::vec3& a = list_.vertices[piece[i]];
      const glm::vec3& b = list_.vertices[piece[(i + 1) % 3]];
      const float length_m2 = glm::dot(b - a, b - a);
      if (!(length_m2 > longest_m2) || !std::isfinite(length_m2)) continue;
      const glm::vec3 middle = 0.5F * (a + b);
      if (middle == a || middle == b) continue;  // neighbours among floats
      longest = i;
      longest_m2 = length_m2;
    }
    return longest;
  }

  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    const auto [found, is_new] =
        middles_.try_emplace(key, static_cast<std::uint32_t>(list_.vertices.size()));
    if (is_new) list_.vertices.push_back(0.5F * (list_.vertices[a] + list_.vertices[b]));
    return found->second;
  }

  float limit_m2_;
  std::size_t most_;
  TriangleList& list_;
  std::vector<glm::uvec3> waiting_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;  ///< of edges, by their ends
};

}  // namespace

std::optional<TriangleList> tessellated(const scene::Scene& scene, float longest_edge_m,
                                        std::size_t most) {
  TriangleList list;
  list.triangles.reserve(scene.face_count());
  const float limit_m2 = longest_edge_m > 0.0F ? longest_edge_m * longest_edge_m
                                               : std::numeric_limits<float>::infinity();
  Cutter cutter(limit_m2, most, list);
  for (const scene::Object& object : scene.objects) {
    const auto first = static_cast<std::uint32_t>(list.vertices.size());
    for (const glm::vec3& position : object.mesh->positions) {
      list.vertices.push_back(glm::vec3(object.to_world * glm::vec4(position, 1.0F)));
    }
    for (const glm::uvec3& index : object.mesh->triangles) {
      if (!cutter.cut(first + index)) return std::nullopt;
    }
  }
  return list;
}

}  // namespace renderers::shadow_maps
