#pragma once

#include <string>
#include <vector>

#include "renderers/shadow_maps/hemisphere_maps.h"
#include "tests/renderers/shadow_maps/map_bench.h"

/// Visibility between lights and points on surfaces by Embree, and how lookups differ from it.
namespace renderers::test {

/// A scene of suites/scenes.
scene::Scene catalog_scene(const std::string& name);
/// Closed, from -1 to 1, fronts inside.
scene::Scene empty_box();
scene::Scene scaled(scene::Scene scene, float factor);

struct VisibilityTruth {
  std::vector<Lookup> lookups;
  std::vector<bool> is_lit;
  int lit = 0;
  int shadowed = 0;
};

/// Points on the scene's surfaces above the horizon of each origin (and not in its plane).
VisibilityTruth visibility_truth(const MapBench& bench, const std::vector<Origin>& origins,
                                 int points);

struct VisibilityError {
  double false_shadow = 0.0;  ///< share of the lit points
  double leak = 0.0;          ///< share of the shadowed points
};
VisibilityError visibility_error(const VisibilityTruth& truth,
                                 const shadow_maps::HemisphereMaps& maps,
                                 const std::vector<Origin>& origins,
                                 const shadow_maps::LookupBias& bias);

/// True if, among points within one texel around the receiver's direction, rays meet something
/// well before the receiver's plane in some and not in others.
bool is_near_silhouette(const MapBench& bench, const shadow_maps::HemisphereMaps& maps,
                        const std::vector<Origin>& origins, const Lookup& lookup);

}  // namespace renderers::test
