#include "renderers/area_shadows/discontinuity_pyramid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

namespace {

/// Calls body(x, y) for every block, rows in parallel.
template <typename Body>
void for_each_block(int columns, int rows, const Body& body) {
  base::parallel_for(static_cast<std::size_t>(rows), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (int x = 0; x < columns; ++x) body(x, static_cast<int>(y));
    }
  });
}

/// The neighbour's distance from the pixel's plane.
float distance_from_plane(const PixelSurface& pixel, const PixelSurface& neighbour) {
  return std::fabs(glm::dot(pixel.receiver.geometric_normal,
                            neighbour.receiver.position - pixel.receiver.position));
}

}  // namespace

DiscontinuityPyramid::DiscontinuityPyramid(const PixelSurfaces& surfaces,
                                           const DiscontinuitySettings& settings, int levels)
    : settings_(settings), levels_(static_cast<std::size_t>(levels)) {
  assert(levels >= 1);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    level.columns = i == 0 ? surfaces.width_px : (levels_[i - 1].columns + 1) / 2;
    level.rows = i == 0 ? surfaces.height_px : (levels_[i - 1].rows + 1) / 2;
    level.blocks.resize(static_cast<std::size_t>(level.columns) *
                        static_cast<std::size_t>(level.rows));
    for_each_block(level.columns, level.rows, [&](int x, int y) {
      const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(level.columns) +
                         static_cast<std::size_t>(x);
      level.blocks[index] = i == 0 ? block_of_pixel(surfaces, x, y) : merged(levels_[i - 1], x, y);
    });
  }
}

DiscontinuityPyramid::Block DiscontinuityPyramid::block_of_pixel(const PixelSurfaces& surfaces,
                                                                 int x, int y) const {
  const PixelSurface& pixel = surfaces.at(x, y);
  Block block;
  if (!pixel.is_surface()) return block;
  block.has_surface = true;
  float least_m = pixel.depth_m;
  float greatest_m = pixel.depth_m;
  float off_plane_m = 0.0F;
  for (int j = std::max(0, y - 1); j <= std::min(surfaces.height_px - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(surfaces.width_px - 1, x + 1); ++i) {
      const PixelSurface& neighbour = surfaces.at(i, j);
      if (!neighbour.is_surface()) {
        off_plane_m = greatest_m = std::numeric_limits<float>::infinity();
        continue;
      }
      const glm::vec3 normal = surfaces.to_eye * neighbour.receiver.normal;
      block.normal_low = glm::min(block.normal_low, normal);
      block.normal_high = glm::max(block.normal_high, normal);
      least_m = std::min(least_m, neighbour.depth_m);
      greatest_m = std::max(greatest_m, neighbour.depth_m);
      off_plane_m = std::max(off_plane_m, distance_from_plane(pixel, neighbour));
    }
  }
  const float change_m =
      settings_.depth == DepthMeasure::plane ? off_plane_m : greatest_m - least_m;
  block.depth_change = change_m / pixel.depth_m;
  return block;
}

DiscontinuityPyramid::Block DiscontinuityPyramid::merged(const Level& finer, int x, int y) {
  Block block;
  for (int j = 2 * y; j < std::min(finer.rows, 2 * y + 2); ++j) {
    for (int i = 2 * x; i < std::min(finer.columns, 2 * x + 2); ++i) {
      const Block& part =
          finer.blocks[static_cast<std::size_t>(j) * static_cast<std::size_t>(finer.columns) +
                       static_cast<std::size_t>(i)];
      block.depth_change = std::max(block.depth_change, part.depth_change);
      block.normal_low = glm::min(block.normal_low, part.normal_low);
      block.normal_high = glm::max(block.normal_high, part.normal_high);
      block.has_surface = block.has_surface || part.has_surface;
    }
  }
  return block;
}

float DiscontinuityPyramid::normal_change(const Block& block) const {
  const glm::vec3 range = block.normal_high - block.normal_low;
  if (settings_.normal == NormalMeasure::range) return std::max(range.x, range.y);
  // |a - b|^2 = 2 (1 - cos) for unit vectors; the box's diagonal bounds |a - b|.
  return 0.5F * glm::dot(range, range);
}

bool DiscontinuityPyramid::is_discontinuous(int level, int x, int y) const {
  const Block& of = block(level, x, y);
  if (!of.has_surface) return false;
  const float depth_threshold =
      settings_.depth == DepthMeasure::range
          ? settings_.depth_threshold * 3.0F / static_cast<float>(std::max(1, level))
          : settings_.depth_threshold;
  return of.depth_change >= depth_threshold || normal_change(of) >= settings_.normal_threshold;
}

}  // namespace renderers::area_shadows
