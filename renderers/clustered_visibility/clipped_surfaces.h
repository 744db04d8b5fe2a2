#pragma once

#include <cstdint>
#include <vector>

#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/scene/scene.h"

namespace renderers::clustered_visibility {

/// What the maps of area lights leave out: surfaces above a map's horizon that are lower than its
/// clip height, the size of `AreaLight::axis.w` (below 0: only those seen from behind). The lights'
/// own surface is meant; real blockers that near are left out with it (Dong et al. 2009, Sec. 5.1:
/// the bias along the normal).
struct ClippedSurfaces {
  /// Pairs of triangle and map of which nothing above the horizon is left.
  std::int64_t triangles = 0;
  /// Solid angle of what is left out, in hemispheres, mean over the maps with lights; surfaces
  /// behind each other count each.
  double hemisphere_share = 0.0;
};

/// The same whatever fills the maps, as long as they clip alike: it follows from the triangles and
/// the clip heights alone, and costs no time of the frame.
/// @param near_m  height of the maps' centres above the lights' positions (HemisphereMaps)
ClippedSurfaces clipped_surfaces(const scene::Scene& scene,
                                 const std::vector<AreaLight>& area_lights, float near_m);

}  // namespace renderers::clustered_visibility
