#include "renderers/light_propagation/volume_slices.h"

#include "renderers/light_propagation/intensity_lobe.h"

namespace renderers::light_propagation {

namespace {

using perception::Image;

/// Whole tiles side by side and below each other, and the pixels of a cell.
struct Tiling {
  int columns = 0;
  int rows = 0;
  int cell_px = 1;

  int count() const { return columns * rows; }
};

/// The one with the largest cells that has room for all layers, else for most. Tiles are a cell
/// apart.
Tiling tiling_of(const Grid& grid, int width_px, int height_px) {
  const auto tiling = [&](int cell_px) {
    return Tiling{width_px / (cell_px * (grid.size.x + 1)),
                  height_px / (cell_px * (grid.size.z + 1)), cell_px};
  };
  int cell_px = 1;
  while (tiling(cell_px + 1).count() >= grid.size.y) ++cell_px;
  return tiling(cell_px);
}

}  // namespace

Image slice_picture(const LightVolume& volume, int width_px, int height_px) {
  const Grid& grid = volume.grid;
  const auto [columns, rows, cell_px] = tiling_of(grid, width_px, height_px);
  Image picture =
      perception::make_rgb_image(width_px, height_px, perception::Encoding::scene_linear);
  const float face_m2 = grid.cell_m * grid.cell_m;
  for (int y = 0; y < height_px; ++y) {
    const int row = y / cell_px / (grid.size.z + 1);
    const int z = y / cell_px % (grid.size.z + 1);
    for (int x = 0; x < width_px; ++x) {
      const int column = x / cell_px / (grid.size.x + 1);
      const glm::ivec3 cell(x / cell_px % (grid.size.x + 1), row * columns + column, z);
      if (column >= columns || row >= rows || !grid.holds(cell)) continue;
      const CellLight& light = volume.cells[grid.index(cell)];
      for (int c = 0; c < 3; ++c) picture.at(x, y, c) = flux(channel_of(light, c)) / face_m2;
    }
  }
  return picture;
}

}  // namespace renderers::light_propagation
