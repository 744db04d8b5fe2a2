#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "renderers/texel_atlas/charts.h"

namespace renderers::texel_atlas {

/// A chart's rectangle of texels in the atlas.
struct ChartPlace {
  glm::ivec2 corner{0};          ///< lowest texel in x and y
  glm::ivec2 size{1};            ///< texels
  glm::dvec2 texels_per_m{1.0};  ///< along the chart's axes: the rectangle's sides are whole texels
};

struct ChartLayout {
  int side_px = 0;
  double texels_per_m = 0.0;  ///< asked for or found; a chart's own are at least this
  std::vector<ChartPlace> places;
};

struct LayoutSettings {
  int side_px = 512;          ///< of the square atlas
  int padding_px = 2;         ///< free texels between charts
  double texels_per_m = 0.0;  ///< 0: the most that fits
  std::string scene_name;     ///< for messages
};

/// Packs the rectangles of charts into rows ("shelves") of falling height.
///
/// Source: Coffman, Garey, Johnson, Tarjan 1980, "Performance Bounds for Level-Oriented
/// Two-Dimensional Packing Algorithms", doi:10.1137/0209062 (next-fit decreasing height).
///
/// @throws base::InputError if the charts do not fit at the density, or at any density
ChartLayout lay_out(std::span<const Chart> charts, const LayoutSettings& settings);

}  // namespace renderers::texel_atlas
