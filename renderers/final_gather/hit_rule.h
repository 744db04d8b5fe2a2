#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::final_gather {

/// How visibility near a vertex is tested, whose points may lie before, behind or within the very
/// surfaces that they stand for.
enum class HitRule {
  naive,    ///< from points in the cells, every hit occludes: lit surfaces look shadowed (Fig. 2)
  literal,  ///< more than one sheet, or more than two boundaries of solids (Sec. 4.3)
  local,    ///< that rule within the adjacent cells, beyond them every hit occludes; ours
  surface   ///< from points that the camera sees, every hit occludes; ours
};

/// Objects whose mesh is closed: every edge has two triangles that run along it in opposite
/// directions, by corner positions.
std::vector<bool> solid_objects(const scene::Scene& scene);

/// Tests segments from points in space to points on senders.
class HitCounter {
 public:
  /// @param rays  made with RayQueries::all_hits; must live as long as this
  explicit HitCounter(const ray_tracing::RayScene& rays)
      : rays_(rays), is_solid_(solid_objects(rays.scene())) {}

  /// @param rule      not `surface`
  /// @param is_local  whether a place lies in the adjacent cells; `local` alone asks
  bool is_occluded(const glm::vec3& from, const element_hierarchy::SidePoint& to, HitRule rule,
                   const std::function<bool(const glm::vec3&)>& is_local) const;

 private:
  const ray_tracing::RayScene& rays_;
  std::vector<bool> is_solid_;  ///< per object
};

}  // namespace renderers::final_gather
