#include "renderers/final_gather/hit_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace renderers::final_gather {

namespace {

using Place = std::tuple<float, float, float>;

Place place_of(const glm::vec3& position) { return {position.x, position.y, position.z}; }

bool is_closed(const scene::Mesh& mesh) {
  // Directed edges: a closed mesh has each one and its opposite equally often.
  std::map<std::pair<Place, Place>, int> balance;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const Place from = place_of(mesh.positions[triangle[c]]);
      const Place to = place_of(mesh.positions[triangle[(c + 1) % 3]]);
      if (from == to) continue;
      if (from < to) {
        ++balance[{from, to}];
      } else {
        --balance[{to, from}];
      }
    }
  }
  return !mesh.triangles.empty() &&
         std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

/// One crossing, though rays through edges may report several triangles.
struct Crossing {
  float t;
  bool looks_back;
  std::uint32_t object;
};

}  // namespace

std::vector<bool> solid_objects(const scene::Scene& scene) {
  std::vector<bool> solid;
  for (const scene::Object& object : scene.objects) solid.push_back(is_closed(*object.mesh));
  return solid;
}

bool HitCounter::is_occluded(const glm::vec3& from, const element_hierarchy::SidePoint& to,
                             HitRule rule,
                             const std::function<bool(const glm::vec3&)>& is_local) const {
  const glm::vec3 end =
      ray_tracing::offset_from_surface(to.surface.position, to.surface.position_error,
                                       to.surface.geometric_normal, from - to.surface.position);
  const std::array<ray_tracing::Ray, 1> ray{{{from, end - from, ray_tracing::kSegmentEnd}}};
  std::vector<ray_tracing::LineHit> hits;
  rays_.all_hits(ray, hits);
  std::ranges::sort(hits, {}, &ray_tracing::LineHit::t);
  std::vector<Crossing> crossings;
  for (const ray_tracing::LineHit& hit : hits) {
    constexpr float kSamePlace = 1e-5F;
    const bool is_repeat = std::ranges::any_of(crossings, [&](const Crossing& other) {
      return other.object == hit.object && other.looks_back == hit.looks_back &&
             std::fabs(other.t - hit.t) < kSamePlace;
    });
    if (!is_repeat) crossings.push_back({hit.t, hit.looks_back, hit.object});
  }
  // A sheet costs 1, a boundary of a solid 1/2; more than 1 occludes.
  double cost = 0.0;
  for (const Crossing& crossing : crossings) {
    if (rule == HitRule::naive) return true;
    if (rule == HitRule::local && !is_local(from + crossing.t * ray[0].direction)) return true;
    cost += is_solid_[crossing.object] ? 0.5 : 1.0;
  }
  return cost > 1.0;
}

}  // namespace renderers::final_gather
