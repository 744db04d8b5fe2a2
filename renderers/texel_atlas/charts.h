#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/texel_atlas/world_triangles.h"

namespace renderers::texel_atlas {

/// Which triangles share a chart.
enum class ChartKind {
  triangle,  ///< none: a chart each
  connected  ///< those of an object that meet in edges and face nearly the same way
};

/// Triangles that are projected onto one plane, seen from their front: no two overlap there.
struct Chart {
  std::vector<std::uint32_t> triangles;  ///< indices into WorldTriangles::triangles
  glm::dvec3 origin{0.0};                ///< of the plane's coordinates, m
  glm::dvec3 axis_u{1.0, 0.0, 0.0};      ///< unit length
  glm::dvec3 axis_v{0.0, 1.0, 0.0};      ///< unit length; cross(u, v) is the chart's normal
  glm::dvec2 size_m{0.0};                ///< bounding rectangle from the origin

  /// Coordinates of a point's projection, m; inside the chart's rectangle for its triangles.
  glm::dvec2 project(const glm::dvec3& point) const;
};

struct ChartSettings {
  ChartKind kind = ChartKind::connected;
  /// Greatest angle between the normals of a chart's triangles and its first one's.
  double normal_angle_deg = 30.0;
};

/// Groups triangles, grown over shared edges in the order of the triangles, and puts the smallest
/// rectangle that has a side along an edge around each group. Degenerate triangles get no chart.
///
/// Edges are shared where both corners have the same coordinates and the triangles run through the
/// edge in opposite directions.
std::vector<Chart> make_charts(const WorldTriangles& world, const ChartSettings& settings);

/// The chart's triangles, a chart each.
std::vector<Chart> split_chart(const WorldTriangles& world, const Chart& chart);

}  // namespace renderers::texel_atlas
