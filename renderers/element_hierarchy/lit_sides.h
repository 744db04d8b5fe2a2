#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::element_hierarchy {

/// Which sides of which objects light can reach.
struct LitSides {
  std::vector<std::array<bool, 2>> of_object;  ///< [object]: front, back
  std::uint64_t rays = 0;

  static LitSides all(std::size_t objects) {
    return {std::vector<std::array<bool, 2>>(objects, {true, true}), 0};
  }
};

/// Follows light from its sources from object to object: a side is lit if a ray from a source or
/// from a lit side meets it, or if one of its own rays leaves the scene and there is an
/// environment.
///
/// Insides of closed meshes and outsides of rooms would otherwise be half of all patches, and
/// clusters would spread light over both sides. A side that `rays_per_side` rays miss gets less
/// than about 3 / rays_per_side of the light that leaves any lit side (rule of three, 95 %).
/// @param rays_per_side  >= 1
LitSides find_lit_sides(const ray_tracing::RayScene& rays, int rays_per_side);

}  // namespace renderers::element_hierarchy
