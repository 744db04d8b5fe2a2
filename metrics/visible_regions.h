#pragma once

#include <cstddef>
#include <vector>

#include "metrics/metric.h"

namespace metrics {

/// Connected parts of a map, each with its bounding box.
struct VisibleRegions {
  std::vector<Region> largest;  ///< by number of pixels, then from the top left; value: largest one
  std::size_t count = 0;        ///< of all regions
  std::size_t most_pixels = 0;  ///< of the largest region
};

/// Regions of pixels above a limit, connected along sides and corners.
/// @param map   one channel @param mask  null, or pixels of 0 that belong to no region
/// @param most  how many are listed
VisibleRegions visible_regions(const Image& map, const Image* mask, float limit, std::size_t most);

}  // namespace metrics
