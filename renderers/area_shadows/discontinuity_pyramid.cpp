#include "renderers/area_shadows/discontinuity_pyramid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kRowGrain = 8;

/// Calls body(y) for rows, some at a time in parallel.
template <typename Body>
void for_each_row(int rows, const Body& body) {
  base::parallel_for(static_cast<std::size_t>(rows), kRowGrain,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
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
  Blocks blocks;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    blocks = i == 0 ? blocks_of_pixels(surfaces) : merged(blocks);
    judge(blocks, static_cast<int>(i));
  }
}

/// Keeps what will be asked about the blocks of a level.
void DiscontinuityPyramid::judge(const Blocks& blocks, int level) {
  Level& of = levels_[static_cast<std::size_t>(level)];
  of.columns = blocks.columns;
  of.rows = blocks.rows;
  of.facts.resize(blocks.all.size());
  for_each_row(of.rows, [&](int y) {
    for (std::size_t i = blocks.index(0, y); i < blocks.index(0, y + 1); ++i) {
      const Block& block = blocks.all[i];
      of.facts[i] = static_cast<std::uint8_t>((block.has_surface ? kHasSurface : 0U) |
                                              (is_discontinuous(block, level) ? kIsBroken : 0U));
    }
  });
}

DiscontinuityPyramid::Blocks DiscontinuityPyramid::blocks_of_pixels(
    const PixelSurfaces& surfaces) const {
  Blocks blocks(surfaces.width_px, surfaces.height_px);
  // As the camera sees them, once for each pixel and not for each of its neighbours.
  std::vector<glm::vec3> normals(blocks.all.size());
  for_each_row(blocks.rows, [&](int y) {
    for (std::size_t i = blocks.index(0, y); i < blocks.index(0, y + 1); ++i) {
      normals[i] = surfaces.to_eye * surfaces.pixels[i].receiver.normal;
    }
  });
  for_each_row(blocks.rows, [&](int y) {
    for (int x = 0; x < blocks.columns; ++x) {
      blocks.all[blocks.index(x, y)] = block_of_pixel(surfaces, normals, x, y);
    }
  });
  return blocks;
}

DiscontinuityPyramid::Block DiscontinuityPyramid::block_of_pixel(
    const PixelSurfaces& surfaces, const std::vector<glm::vec3>& normals, int x, int y) const {
  const PixelSurface& pixel = surfaces.at(x, y);
  Block block;
  if (!pixel.is_surface()) return block;
  block.has_surface = true;
  float least_m = pixel.depth_m;
  float greatest_m = pixel.depth_m;
  float off_plane_m = 0.0F;
  for (int j = std::max(0, y - 1); j <= std::min(surfaces.height_px - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(surfaces.width_px - 1, x + 1); ++i) {
      const std::size_t index = surfaces.index(i, j);
      const PixelSurface& neighbour = surfaces.pixels[index];
      if (!neighbour.is_surface()) {
        off_plane_m = greatest_m = std::numeric_limits<float>::infinity();
        continue;
      }
      block.normal_low = glm::min(block.normal_low, normals[index]);
      block.normal_high = glm::max(block.normal_high, normals[index]);
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

DiscontinuityPyramid::Blocks DiscontinuityPyramid::merged(const Blocks& finer) {
  Blocks blocks((finer.columns + 1) / 2, (finer.rows + 1) / 2);
  for_each_row(blocks.rows, [&](int y) {
    for (int x = 0; x < blocks.columns; ++x) {
      Block& block = blocks.all[blocks.index(x, y)];
      for (int j = 2 * y; j < std::min(finer.rows, 2 * y + 2); ++j) {
        for (int i = 2 * x; i < std::min(finer.columns, 2 * x + 2); ++i) {
          const Block& part = finer.all[finer.index(i, j)];
          block.depth_change = std::max(block.depth_change, part.depth_change);
          block.normal_low = glm::min(block.normal_low, part.normal_low);
          block.normal_high = glm::max(block.normal_high, part.normal_high);
          block.has_surface = block.has_surface || part.has_surface;
        }
      }
    }
  });
  return blocks;
}

float DiscontinuityPyramid::normal_change(const Block& block) const {
  const glm::vec3 range = block.normal_high - block.normal_low;
  if (settings_.normal == NormalMeasure::range) return std::max(range.x, range.y);
  // |a - b|^2 = 2 (1 - cos) for unit vectors; the box's diagonal bounds |a - b|.
  return 0.5F * glm::dot(range, range);
}

bool DiscontinuityPyramid::is_discontinuous(const Block& block, int level) const {
  if (!block.has_surface) return false;
  const float depth_threshold =
      settings_.depth == DepthMeasure::range
          ? settings_.depth_threshold * 3.0F / static_cast<float>(std::max(1, level))
          : settings_.depth_threshold;
  return block.depth_change >= depth_threshold ||
         normal_change(block) >= settings_.normal_threshold;
}

}  // namespace renderers::area_shadows
