#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/area_shadows/pixel_surfaces.h"

namespace renderers::area_shadows {

enum class DepthMeasure {
  plane,  ///< distance of a pixel's neighbours from its plane, by its depth: slant does not count
  range   ///< (greatest - least depth) / own depth over 3 x 3 pixels
};
enum class NormalMeasure {
  cone,  ///< 1 - cosine between the normals furthest apart, from the box around them
  range  ///< greatest - least of the coordinates to the right and up, as the camera sees them
};

struct DiscontinuitySettings {
  DepthMeasure depth = DepthMeasure::plane;
  NormalMeasure normal = NormalMeasure::cone;
  float depth_threshold = 0.005F;  ///< under `range` 3 / level of it, as depths lie further apart
  float normal_threshold = 0.1F;
};

/// Where surfaces end or bend within square blocks of 2^level pixels, for all levels.
///
/// Each pixel looks at its 3 x 3 neighbours, so that the pixels on both sides of an edge know of
/// it; a block takes the greatest change of its pixels and the box of all their normals. Thus no
/// edge on a block's border is lost. Blocks with a surface and background are always discontinuous.
/// Blocks at the image's end hold fewer pixels.
///
/// Sources: Koa and Johan 2016, doi:10.1145/2949035.2949043, Sec. 3.1.1 (depth and normal curvature
/// discontinuity mipmaps), after Nichols and Wyman 2009, doi:10.1145/1507149.1507162.
/// Differs from the paper: `plane` and `cone` are ours.
class DiscontinuityPyramid {
 public:
  /// @param levels  how many, the pixels' included; >= 1
  DiscontinuityPyramid(const PixelSurfaces& surfaces, const DiscontinuitySettings& settings,
                       int levels);

  int columns(int level) const { return levels_[static_cast<std::size_t>(level)].columns; }
  int rows(int level) const { return levels_[static_cast<std::size_t>(level)].rows; }
  /// Whether any pixel of the block shows a surface.
  bool has_surface(int level, int x, int y) const {
    return (facts(level, x, y) & kHasSurface) != 0;
  }
  /// The same of a pixel by its index in the picture.
  bool has_surface(std::size_t pixel) const { return (levels_[0].facts[pixel] & kHasSurface) != 0; }
  /// Whether one surface value cannot stand for the block. A change as great as the threshold
  /// counts, so that thresholds of 0 leave only pixels.
  bool is_discontinuous(int level, int x, int y) const {
    return (facts(level, x, y) & kIsBroken) != 0;
  }

 private:
  static constexpr std::uint8_t kHasSurface = 1;
  static constexpr std::uint8_t kIsBroken = 2;

  struct Block {
    float depth_change = 0.0F;  ///< infinite next to background
    glm::vec3 normal_low{2.0F};
    glm::vec3 normal_high{-2.0F};
    bool has_surface = false;
  };
  /// Those of one level, which the next coarser one is made of.
  struct Blocks {
    int columns = 0;
    int rows = 0;
    std::vector<Block> all;

    Blocks() = default;
    Blocks(int wide, int high)
        : columns(wide),
          rows(high),
          all(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high)) {}
    std::size_t index(int x, int y) const {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
             static_cast<std::size_t>(x);
    }
  };
  struct Level {
    int columns = 0;
    int rows = 0;
    std::vector<std::uint8_t> facts;  ///< of each block

    Level() = default;
    Level(int wide, int high)
        : columns(wide),
          rows(high),
          facts(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high)) {}
    std::uint8_t* row(int y) {
      return facts.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(columns);
    }
  };

  std::uint8_t facts(int level, int x, int y) const {
    const Level& of = levels_[static_cast<std::size_t>(level)];
    return of.facts[static_cast<std::size_t>(y) * static_cast<std::size_t>(of.columns) +
                    static_cast<std::size_t>(x)];
  }
  Blocks judge_pixels(const PixelSurfaces& surfaces);
  void judge_row(const Blocks& blocks, int row, int level, int y);
  Blocks blocks_of_rows(const PixelSurfaces& surfaces, int least, int end) const;
  float depth_change(const PixelSurfaces& surfaces, int x, int y) const;
  static void add_normals(const Block& from, Block& to);
  static void merge_row(const Blocks& finer, int finer_row, Blocks& coarser, int y);
  static Blocks merged(const Blocks& finer);
  float normal_change(const Block& block) const;
  bool is_discontinuous(const Block& block, int level) const;

  DiscontinuitySettings settings_;
  std::vector<Level> levels_;
};

}  // namespace renderers::area_shadows
