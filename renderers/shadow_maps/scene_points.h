#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include "renderers/scene/scene.h"

namespace renderers::shadow_maps {

/// A disc on a surface, std430 (`ScenePoint` of shaders/splat_points.comp.glsl).
struct ScenePoint {
  glm::vec4 position;  ///< xyz: world space, m; w: radius, m
  glm::vec4 normal;    ///< xyz: geometric, unit length, front side; w: 0
};

/// Sets of points that each cover the scene: density proportional to area, radius such that the
/// discs of a set have the scene's area together.
///
/// Without random numbers. The scene's area is cut into sets x points_per_set equal pieces along
/// the list of triangles; each run of `sets` pieces gives every set one point, so that a set is
/// stratified over the triangles; which set takes which piece of a run is the order of the sets'
/// radical inverses, so that sets of neighbouring index differ. Positions within triangles follow
/// the set's run of an R2 sequence (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", recalled). The points of a deformed scene move with it as far as its areas keep
/// their shares.
///
/// @param sets            >= 1
/// @param points_per_set  >= 1
/// @return points_per_set of set 0, then of set 1 and so on; empty if the scene has no area
std::vector<ScenePoint> scene_points(const scene::Scene& scene, int sets, int points_per_set);

}  // namespace renderers::shadow_maps
