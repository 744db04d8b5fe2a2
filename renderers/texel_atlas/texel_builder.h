#pragma once

#include <cstdint>
#include <vector>

#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/chart_layout.h"
#include "renderers/texel_atlas/texel_atlas.h"
#include "renderers/texel_atlas/world_triangles.h"

namespace renderers::texel_atlas {

/// Texels of one chart, in rows.
struct ChartTexels {
  std::vector<Texel> texels;
  /// Per cell of the chart's rectangle, index into `texels` or kNoTexel.
  std::vector<std::uint32_t> cells;
  /// The projections of its triangles lie over each other somewhere.
  bool overlaps = false;
};

/// Cuts the triangles of a chart along the cells. Pieces smaller than a quarter of a cell join the
/// largest of the pieces next to them, if there is one.
ChartTexels cut_chart(const WorldTriangles& world, const ray_tracing::RayScene& rays,
                      const Chart& chart, const ChartPlace& place);

}  // namespace renderers::texel_atlas
