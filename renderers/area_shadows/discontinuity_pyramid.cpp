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
/// Rows of pixels at a time, an even number: what is found out about them stays in a cache.
constexpr int kStripRows = 8;

/// Calls body(y) for rows, some at a time in parallel.
template <typename Body>
void for_each_row(int rows, std::size_t grain, const Body& body) {
  base::parallel_for(static_cast<std::size_t>(rows), grain,
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
  Blocks blocks = judge_pixels(surfaces);
  for (int level = 1; level < levels; ++level) {
    levels_[static_cast<std::size_t>(level)] = Level(blocks.columns, blocks.rows);
    for_each_row(blocks.rows, kRowGrain, [&](int y) { judge_row(blocks, y, level, y); });
    blocks = merged(blocks);
  }
}

/// Keeps what will be asked about a row of blocks.
void DiscontinuityPyramid::judge_row(const Blocks& blocks, int row, int level, int y) {
  std::uint8_t* facts = levels_[static_cast<std::size_t>(level)].row(y);
  for (int x = 0; x < blocks.columns; ++x) {
    const Block& block = blocks.all[blocks.index(x, row)];
    facts[x] = static_cast<std::uint8_t>((block.has_surface ? kHasSurface : 0U) |
                                         (is_discontinuous(block, level) ? kIsBroken : 0U));
  }
}

/// Level 0, whose blocks are many: some rows of them at a time. @return the blocks of level 1
DiscontinuityPyramid::Blocks DiscontinuityPyramid::judge_pixels(const PixelSurfaces& surfaces) {
  levels_[0] = Level(surfaces.width_px, surfaces.height_px);
  Blocks coarser((surfaces.width_px + 1) / 2, (surfaces.height_px + 1) / 2);
  const int strips = (surfaces.height_px + kStripRows - 1) / kStripRows;
  for_each_row(strips, 1, [&](int strip) {
    const int least = strip * kStripRows;
    const int end = std::min(surfaces.height_px, least + kStripRows);
    const Blocks blocks = blocks_of_rows(surfaces, least, end);
    for (int y = least; y < end; ++y) judge_row(blocks, y - least, 0, y);
    for (int y = least / 2; 2 * y < end; ++y) merge_row(blocks, 2 * y - least, coarser, y);
  });
  return coarser;
}

DiscontinuityPyramid::Blocks DiscontinuityPyramid::blocks_of_rows(const PixelSurfaces& surfaces,
                                                                  int least, int end) const {
  const int width = surfaces.width_px;
  const int above = std::max(0, least - 1);
  const int below = std::min(surfaces.height_px, end + 1);
  // Normals as the camera sees them, once for each pixel and not for each of its neighbours.
  Blocks own(width, below - above);
  for (int y = above; y < below; ++y) {
    for (int x = 0; x < width; ++x) {
      const PixelSurface& pixel = surfaces.at(x, y);
      if (!pixel.is_surface()) continue;
      Block& block = own.all[own.index(x, y - above)];
      block.normal_low = block.normal_high = surfaces.to_eye * pixel.receiver.normal;
    }
  }
  Blocks blocks(width, end - least);
  std::vector<Block> columns(static_cast<std::size_t>(width));
  for (int y = least; y < end; ++y) {
    // The box around three normals below each other, then around three such boxes.
    columns.assign(columns.size(), Block());
    for (int j = std::max(above, y - 1); j < std::min(below, y + 2); ++j) {
      for (int x = 0; x < width; ++x) {
        add_normals(own.all[own.index(x, j - above)], columns[static_cast<std::size_t>(x)]);
      }
    }
    for (int x = 0; x < width; ++x) {
      Block& block = blocks.all[blocks.index(x, y - least)];
      if (!surfaces.at(x, y).is_surface()) continue;
      block.has_surface = true;
      block.depth_change = depth_change(surfaces, x, y);
      for (int i = std::max(0, x - 1); i < std::min(width, x + 2); ++i) {
        add_normals(columns[static_cast<std::size_t>(i)], block);
      }
    }
  }
  return blocks;
}

/// Of a pixel with a surface, by its depth.
float DiscontinuityPyramid::depth_change(const PixelSurfaces& surfaces, int x, int y) const {
  const PixelSurface& pixel = surfaces.at(x, y);
  float least_m = pixel.depth_m;
  float greatest_m = pixel.depth_m;
  float off_plane_m = 0.0F;
  for (int j = std::max(0, y - 1); j <= std::min(surfaces.height_px - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(surfaces.width_px - 1, x + 1); ++i) {
      const PixelSurface& neighbour = surfaces.at(i, j);
      if (!neighbour.is_surface()) return std::numeric_limits<float>::infinity();
      least_m = std::min(least_m, neighbour.depth_m);
      greatest_m = std::max(greatest_m, neighbour.depth_m);
      off_plane_m = std::max(off_plane_m, distance_from_plane(pixel, neighbour));
    }
  }
  const float change_m =
      settings_.depth == DepthMeasure::plane ? off_plane_m : greatest_m - least_m;
  return change_m / pixel.depth_m;
}

void DiscontinuityPyramid::add_normals(const Block& from, Block& to) {
  to.normal_low = glm::min(to.normal_low, from.normal_low);
  to.normal_high = glm::max(to.normal_high, from.normal_high);
}

/// A row of blocks from two of the next finer level, or the last one of it.
void DiscontinuityPyramid::merge_row(const Blocks& finer, int finer_row, Blocks& coarser, int y) {
  for (int x = 0; x < coarser.columns; ++x) {
    Block& block = coarser.all[coarser.index(x, y)];
    for (int j = finer_row; j < std::min(finer.rows, finer_row + 2); ++j) {
      for (int i = 2 * x; i < std::min(finer.columns, 2 * x + 2); ++i) {
        const Block& part = finer.all[finer.index(i, j)];
        block.depth_change = std::max(block.depth_change, part.depth_change);
        add_normals(part, block);
        block.has_surface = block.has_surface || part.has_surface;
      }
    }
  }
}

DiscontinuityPyramid::Blocks DiscontinuityPyramid::merged(const Blocks& finer) {
  Blocks blocks((finer.columns + 1) / 2, (finer.rows + 1) / 2);
  for_each_row(blocks.rows, kRowGrain, [&](int y) { merge_row(finer, 2 * y, blocks, y); });
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
