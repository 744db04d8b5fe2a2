#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <glm/fwd.hpp>
#include <glm/gtc/type_precision.hpp>

#include "renderers/element_hierarchy/surface_pieces.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::element_hierarchy {

/// A ray that meets nothing.
inline constexpr std::uint32_t kNoSide = std::numeric_limits<std::uint32_t>::max();

/// What a ray from a side meets.
struct SeenSide {
  std::uint32_t side = kNoSide;  ///< 2 piece + back
  glm::u16vec2 place{0};         ///< weights of the piece's second and third corner, 65535: 1
};

/// A place on an area light that a side sees: met by rays towards points drawn on the lights or by
/// the cosine-distributed ones, weighted by the balance heuristic, w_i = n_i p_i / sum_k n_k p_k.
/// Their sum is the irradiance that the lights bring. Source: Veach and Guibas 1995, "Optimally
/// Combining Sampling Techniques for Monte Carlo Rendering", doi:10.1145/218380.218498 (equation's
/// number not at hand).
struct SeenLamp {
  SeenSide met;
  float weight = 0.0F;  ///< irradiance by the radiosity there
};

/// Which sides of a scene's pieces light can reach.
struct LitSides {
  std::shared_ptr<const SurfacePieces> pieces;
  std::vector<bool> is_lit;  ///< [2 piece + back]
  std::size_t rays_per_side = 0;
  std::vector<SeenSide> seen;  ///< [side][ray]: what a cosine-distributed ray from it meets
  std::vector<std::vector<SeenLamp>> lamps;  ///< per side
  std::uint64_t rays = 0;
};

/// Follows light from its sources: emissive fronts, sides that a light lights directly and sides
/// with a ray to the environment are lit; so is a side of whose n cosine-distributed rays at least
/// max(2, n / 16) meet lit sides, again and again. One ray is not enough: it may have leaked
/// through an edge.
///
/// Insides of closed meshes, cavities and outsides of rooms would otherwise be a large part of all
/// patches; clusters spread light over all that is in them, and what falls on hidden surfaces is
/// lost. A side that is left out sees lit ones in a few of its rays at most.
/// @param rays_per_side  n, >= 8
LitSides find_lit_sides(const ray_tracing::RayScene& rays,
                        std::shared_ptr<const SurfacePieces> pieces, std::size_t rays_per_side);

}  // namespace renderers::element_hierarchy
