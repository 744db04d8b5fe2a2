#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::element_hierarchy {

/// A ray that meets nothing.
inline constexpr std::uint32_t kNoSide = std::numeric_limits<std::uint32_t>::max();

/// Which sides of which triangles light can reach.
struct LitSides {
  std::vector<std::size_t> first;  ///< per object, of its triangles in `is_lit`
  std::vector<bool> is_lit;        ///< [2 triangle + back]
  std::size_t rays_per_side = 0;
  /// [side][ray]: the side that a cosine-distributed ray from it meets, as in `is_lit`; kNoSide:
  /// none.
  std::vector<std::uint32_t> seen;
  std::uint64_t rays = 0;

  bool at(std::uint32_t object, std::uint32_t triangle, bool is_back) const {
    return is_lit[2 * (first[object] + triangle) + (is_back ? 1 : 0)];
  }
};

/// Follows light from its sources: emissive fronts, sides that a light lights directly and sides
/// with a ray to the environment are lit; so is a side of whose n cosine-distributed rays at least
/// max(2, n / 256) meet lit sides, again and again. One ray is not enough: it may have leaked
/// through an edge.
///
/// Insides of closed meshes, cavities and outsides of rooms would otherwise be a large part of all
/// patches; clusters spread light over all that is in them, and what falls on hidden surfaces is
/// lost. A side that is left out sees lit ones in a few of its rays at most.
/// @param rays_per_side  n, >= 8
LitSides find_lit_sides(const ray_tracing::RayScene& rays, std::size_t rays_per_side);

}  // namespace renderers::element_hierarchy
