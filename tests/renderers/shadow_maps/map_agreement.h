#pragma once

#include <functional>
#include <vector>

#include "tests/renderers/shadow_maps/map_bench.h"

/// Maps against rays, texel by texel.
namespace renderers::test {

/// How a layer's distances compare with those along rays.
struct Agreement {
  double median_error = 0.0;  ///< relative, of texels that hit something both ways
  int texels = 0;
  int differing = 0;    ///< by more than the tolerance, or hit one way only
  int unexplained = 0;  ///< of them, those without an excuse
};

bool is_alike(float a, float b, float tolerance);

/// Whether a texel at a position may differ by this distance.
using Excuse = std::function<bool(const glm::dvec2& position, float distance)>;

/// A map, and what it is seen from.
struct SeenFrom {
  const MapBench& bench;
  const Origin& origin;
  float near_m;
};

/// Some ray within 2e-5 of the map's radius gives the map's distance: rounding at a silhouette.
Excuse rounding_excuse(const SeenFrom& seen);
/// Among the rays within a reach, of the map's radius, some hit nothing or something a tenth
/// farther away than others: a silhouette, or a surface seen edge-on.
Excuse silhouette_excuse(const SeenFrom& seen, double reach);

/// @param distances  m, row-major
/// @param tolerance  relative, beyond which they differ
Agreement agreement_of(const SeenFrom& seen, int size_px, const std::vector<float>& distances,
                       const Excuse& excuse, float tolerance = 1e-3F);

}  // namespace renderers::test
